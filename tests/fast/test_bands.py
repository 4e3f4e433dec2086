"""hdrlab.fast._bands: the result in bands equals that of the whole image."""

import numpy as np
import pytest

from hdrlab.core.filters import pyramid as lesson
from hdrlab.errors import InputError
from hdrlab.fast import _bands as bands, pyramid as quick, with_parts
from hdrlab.tonemap import chiu


def noise(shape, seed=0):
    """Return white noise, float32."""
    return np.random.default_rng(seed).random(shape).astype(np.float32)


@pytest.mark.parametrize("height", [1, 2, 31, 32, 33, 95, 200])
def test_computing_in_bands_gives_the_same_result_as_the_whole_image(height):
    u = noise((height, 9))

    def neighbours(u):
        around = np.pad(u, 1, mode="symmetric")
        return around[:-2, 1:-1] - around[2:, 1:-1]

    down = bands.banded(neighbours, u, margin=1)
    assert np.array_equal(down, neighbours(u)) and down.dtype == u.dtype


def test_bands_take_planes_and_several_pictures():
    u = noise((70, 9))
    planes = noise((3, 70, 9), 1)
    assert np.array_equal(
        bands.banded(lambda u, p: u * p.sum(axis=0), u, planes), u * planes.sum(axis=0)
    )


def test_pyramids_of_several_bands_and_planes_equal_those_of_the_lesson():
    rng = np.random.default_rng(2)
    picture = rng.uniform(0, 1, (2, 300, 261)).astype(np.float32)
    for result, expected in zip(
        quick.laplacian(picture, 3), lesson.laplacian(picture, 3), strict=True
    ):
        np.testing.assert_allclose(result, expected, atol=1e-6)
    fine = quick.interpolate(picture[0], (600, 522))
    np.testing.assert_allclose(fine, lesson.interpolate(picture[0], (600, 522)), atol=1e-6)


def test_images_without_rows_raise_an_error():
    with pytest.raises(InputError, match="row"):
        bands.banded(np.negative, np.empty((0, 4)))


def test_replacing_a_function_that_the_lesson_does_not_call_raises_an_error():
    with pytest.raises(InputError, match="gausian_filter"):
        with_parts(__name__, chiu.scale, gausian_filter=np.negative)
