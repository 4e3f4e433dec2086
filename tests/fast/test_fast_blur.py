"""hdrlab.fast.blur: Gaussians as matrix products, against the plain sum."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from scipy.ndimage import gaussian_filter

from hdrlab.errors import InputError
from hdrlab.fast import blur


def radiance(shape, seed=0):
    rng = np.random.default_rng(seed)
    light = gaussian_filter(rng.standard_normal(shape), 6)
    return np.exp(2 * light / light.std() + 0.3 * rng.standard_normal(shape)).astype(np.float32)


@settings(max_examples=40, deadline=None)
@given(height=st.integers(1, 70), width=st.integers(1, 70), sigma=st.floats(0.05, 3.99))
def test_a_narrow_blur_equals_the_plain_sum_in_float32(height, width, sigma):
    image = (
        radiance((height, width))
        if min(height, width) > 3
        else np.random.default_rng(1).random((height, width))
    )
    plain = gaussian_filter(image.astype(np.float64), sigma)
    assert np.allclose(blur.gaussian(image, sigma), plain, rtol=2e-6)


@pytest.mark.parametrize("sigma", [4, 5.5, 7.99, 8, 12, 16, 33, 50])
def test_a_wide_kernel_differs_from_a_gaussian_by_less_than_a_five_hundredth_of_its_peak(sigma):
    point = np.zeros((420, 421), np.float32)
    point[203, 210] = 1
    plain = gaussian_filter(point.astype(np.float64), sigma)
    assert np.abs(blur.gaussian(point, sigma) - plain).max() < 0.002 * plain.max()


@pytest.mark.parametrize("shape", [(1, 1), (2, 3), (7, 1), (1, 90), (37, 64), (130, 257)])
@pytest.mark.parametrize("sigma", [4, 9, 40, 200])
def test_a_wide_blur_reflects_at_the_edges_like_the_plain_one(shape, sigma):
    image = 1 + np.random.default_rng(2).random(shape)
    assert np.allclose(blur.gaussian(image, sigma), gaussian_filter(image, sigma), rtol=3e-3)


@pytest.mark.parametrize("sigma", [4, 9, 16])
def test_a_wide_blur_leaves_a_straight_ramp_as_it_is(sigma):
    ramp = np.add.outer(np.arange(240), 2 * np.arange(230)).astype(np.float32)
    far_from_the_edges = (slice(90, 150), slice(90, 140))
    blurred = blur.gaussian(ramp, sigma)
    assert np.allclose(blurred[far_from_the_edges], ramp[far_from_the_edges], rtol=1e-4)


@pytest.mark.parametrize("sigma", [4, 5.9, 11.3, 32.6])
def test_the_tail_of_a_wide_blur_is_right_within_15_percent_six_decades_below_a_lamp(sigma):
    """Relative to the light that arrives there, of which a sum cut at four sigma misses three quarters."""
    image = np.full((200, 260), 1e-3, np.float32)
    image[80:90, 100:120] = 1e3
    exact = gaussian_filter(image.astype(np.float64), sigma, mode="reflect", truncate=7)
    assert np.abs(blur.gaussian(image, sigma) / exact - 1).max() < 0.15
    cut_at_four_sigma = gaussian_filter(image.astype(np.float64), sigma, mode="reflect")
    assert np.abs(cut_at_four_sigma / exact - 1).max() > 0.75


@pytest.mark.parametrize("sigma", [0, -1, np.inf, np.nan])
def test_a_sigma_that_is_not_positive_and_finite_raises_an_error(sigma):
    with pytest.raises(InputError, match="sigma"):
        blur.gaussian(np.ones((4, 4)), sigma)


@pytest.mark.parametrize("shape", [(4,), (0, 4), (4, 4, 3)])
def test_invalid_images_raise_an_error(shape):
    with pytest.raises(InputError, match="image"):
        blur.gaussian(np.ones(shape), 1.0)
