"""Radiance maps of unusual brackets: one pixel, one row, other byte orders, absurd times."""

import numpy as np
import pytest

from hdrlab import pipeline
from hdrlab.capture import camera
from hdrlab.core.bracket import bracket
from hdrlab.errors import InputError

RNG = np.random.default_rng(0)
LIGHT = 10 ** RNG.uniform(-2, 2, (60, 80, 1)) * RNG.uniform(0.5, 1, 3)
TAKEN = camera.shoot(LIGHT, camera.times_around(LIGHT, 4, stops=2), camera.Camera(), rng=1)


class ArrayLike:
    """An object that has only the method by which NumPy reads it."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None, copy=None):
        return self.array if dtype is None else self.array.astype(dtype)


def assemble(images, times=TAKEN.times):
    return pipeline.assemble(bracket(images, times), align="none").E


@pytest.mark.parametrize("shape", [(1, 1), (1, 80), (60, 1), (3, 3)])
def test_photos_of_a_pixel_or_a_row_have_a_map(shape):
    E = assemble(TAKEN.images[:, : shape[0], : shape[1]])
    assert E.shape == (*shape, 3)
    assert np.isfinite(E).all()
    assert E.max() > 0


def test_map_does_not_depend_on_how_the_photos_are_stored():
    expected = assemble(TAKEN.images)
    for images in (
        np.asfortranarray(TAKEN.images),
        [ArrayLike(image) for image in TAKEN.images],
        np.repeat(TAKEN.images, 2, axis=1)[:, ::2],
    ):
        assert np.array_equal(assemble(images), expected)


def test_photos_of_16_bits_can_have_either_byte_order():
    images = TAKEN.images.astype(np.uint16) * 257
    assert np.array_equal(assemble(images.astype(">u2")), assemble(images.astype("<u2")))


@pytest.mark.parametrize("level", [0, 255])
def test_photos_that_are_all_black_or_all_white_have_no_response(level):
    with pytest.raises(InputError, match="well exposed"):
        assemble(np.full_like(TAKEN.images, level))


@pytest.mark.parametrize("factor", [1e300, 1e-300, np.nan, 0, -1])
def test_times_that_no_camera_has_are_refused(factor):
    with pytest.raises(InputError, match="times"):
        assemble(TAKEN.images, TAKEN.times * factor)


@pytest.mark.parametrize("factor", [1e25, 1e-25])
def test_relative_times_of_any_usual_size_give_the_same_picture(factor):
    expected = pipeline.develop(assemble(TAKEN.images)).astype(int)
    picture = pipeline.develop(assemble(TAKEN.images, TAKEN.times * factor))
    assert np.abs(picture - expected).max() <= 1


@pytest.mark.parametrize(
    "images",
    [
        np.ma.masked_greater(TAKEN.images, 250),
        TAKEN.images / 255,
        TAKEN.images * np.nan,
        TAKEN.images.astype(np.int16),
        TAKEN.images[:, :0],
    ],
    ids=["masked", "floats", "NaN", "signed", "empty"],
)
def test_images_that_are_no_photos_are_refused(images):
    with pytest.raises(InputError, match="images"):
        assemble(images)
