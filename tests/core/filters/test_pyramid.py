"""Image pyramids of every size, compared with OpenCV."""

import cv2
import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.core.filters import pyramid
from hdrlab.fast import pyramid as fast

SHAPES = [(2, 2), (2, 3), (5, 9), (32, 31), (33, 64), (64, 65), (97, 130)]


def noise(shape, seed=0):
    """Return white noise, float32."""
    return np.random.default_rng(seed).random(shape).astype(np.float32)


def test_a_level_is_the_plain_sum_over_the_kernel():
    image = noise((9, 12))
    w = np.array([1, 4, 6, 4, 1]) / 16
    around = np.pad(image, 2, mode="reflect")
    plain = [
        [w @ around[2 * i : 2 * i + 5, 2 * j : 2 * j + 5] @ w for j in range(6)] for i in range(5)
    ]
    assert np.allclose(pyramid.reduce(image), plain, atol=1e-6)


def test_a_point_is_expanded_to_the_kernel():
    point = np.zeros((7, 7), np.float32)
    point[3, 3] = 1
    w = np.array([1, 4, 6, 4, 1]) / 8
    assert np.allclose(pyramid.expand(point, (14, 14))[4:9, 4:9], np.outer(w, w))
    tent = np.array([1, 2, 1]) / 2
    assert np.allclose(pyramid.interpolate(point, (14, 14))[5:8, 5:8], np.outer(tent, tent))


@pytest.mark.parametrize("shape", SHAPES)
def test_reduce_and_expand_equal_those_of_opencv(shape):
    image = noise(shape)
    coarse = pyramid.reduce(image)
    assert np.allclose(coarse, cv2.pyrDown(image), atol=1e-6)
    assert np.allclose(
        pyramid.expand(coarse, shape), cv2.pyrUp(coarse, dstsize=shape[::-1]), atol=1e-6
    )


@given(height=st.integers(1, 70), width=st.integers(1, 70), levels=st.integers(1, 8))
def test_the_laplacian_pyramid_collapses_to_its_image_at_every_size(height, width, levels):
    image = noise((height, width))
    details = pyramid.laplacian(image, levels)
    until_a_pixel = (max(height, width) - 1).bit_length() + 1
    assert len(details) == min(levels, until_a_pixel) and details[0].shape == image.shape
    assert np.allclose(pyramid.collapse(details), image, atol=1e-5)


@given(height=st.integers(1, 40), width=st.integers(1, 40))
def test_a_constant_stays_a_constant(height, width):
    flat = np.full((height, width), 3.5, np.float32)
    coarse = pyramid.reduce(flat)
    assert coarse.shape == ((height + 1) // 2, (width + 1) // 2) and np.allclose(coarse, 3.5)
    for finer in (pyramid.expand, pyramid.interpolate):
        assert np.allclose(finer(coarse, flat.shape), 3.5)
    assert all(np.allclose(detail, 0, atol=1e-5) for detail in pyramid.laplacian(flat, 4)[:-1])


def test_linear_interpolation_keeps_a_ramp_and_the_pixels_it_lies_on():
    ramp = np.add.outer(3 * np.arange(9.0), np.arange(12.0)).astype(np.float32)
    fine = pyramid.interpolate(ramp, (17, 23))
    assert np.array_equal(fine[::2, ::2], ramp)
    assert np.allclose(fine, np.add.outer(1.5 * np.arange(17), 0.5 * np.arange(23)), atol=1e-5)


def test_planes_are_processed_independently():
    image = noise((3, 21, 34))
    for level, planes in enumerate(pyramid.laplacian(image, 4)):
        alone = [pyramid.laplacian(plane, 4)[level] for plane in image]
        assert np.allclose(planes, alone, atol=1e-6)


def test_the_pyramid_does_not_change_its_argument():
    image = noise((20, 30))
    image.setflags(write=False)
    pyramid.laplacian(image, 3)
    assert np.array_equal(image, noise((20, 30)))


@pytest.mark.parametrize(
    ("shape", "smallest", "levels"),
    [((1080, 1920), 32, 6), ((31, 999), 32, 1), ((64, 64), 32, 2), ((63, 63), 32, 2), ((62, 70), 32, 1),
     ((1, 1), 2, 1), ((8, 8), 2, 3)],
)  # fmt: skip
def test_the_depth_is_the_last_level_that_is_large_enough(shape, smallest, levels):
    assert pyramid.depth(shape, smallest) == levels
    sides = [min(level.shape) for level in pyramid.gaussian(noise(shape), levels)]
    assert levels == 1 or sides[-1] >= smallest


def test_shapes_that_do_not_fit_raise_an_error():
    with pytest.raises(ValueError, match="image"):
        pyramid.reduce(np.ones(5))
    with pytest.raises(ValueError, match=r"sides \(5, 6\)"):
        pyramid.expand(np.ones((5, 5)), (10, 11))


@pytest.mark.parametrize("build", [pyramid.laplacian, fast.laplacian])
@pytest.mark.parametrize("levels", [np.inf, 10**9])
def test_a_pyramid_ends_at_one_pixel_at_the_latest(build, levels):
    levels_built = build(np.ones((3, 5), np.float32), levels)
    assert [level.shape for level in levels_built] == [(3, 5), (2, 3), (1, 2), (1, 1)]
