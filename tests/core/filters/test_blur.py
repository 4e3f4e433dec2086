"""The Gaussian filters of hdrlab.core.filters.blur and hdrlab.fast."""

import numpy as np
import pytest
from scipy.ndimage import correlate1d

from hdrlab.core.filters import blur
from hdrlab.fast import blur as fast

BOTH = pytest.mark.parametrize("gaussian", [blur.gaussian, fast.gaussian], ids=["lesson", "fast"])


@BOTH
@pytest.mark.parametrize("sigma", [0.3, 2, 6, 20])
def test_a_blur_keeps_a_constant_the_total_and_the_sign(gaussian, sigma):
    assert np.allclose(gaussian(np.full((30, 41), 3.7), sigma), 3.7, rtol=1e-5)
    image = np.exp(2 * np.random.default_rng(0).standard_normal((64, 80))).astype(np.float32)
    assert gaussian(image, sigma).sum() == pytest.approx(image.sum(), rel=1e-3)
    assert gaussian(image, sigma).min() > 0


@BOTH
@pytest.mark.parametrize("sigma", [1, 6])
def test_a_blur_commutes_with_transposing_and_flipping(gaussian, sigma):
    image = np.exp(np.random.default_rng(0).standard_normal((50, 72))).astype(np.float32)
    blurred = gaussian(image, sigma)
    assert np.allclose(gaussian(image.T, sigma).T, blurred, rtol=1e-5)
    assert np.allclose(gaussian(image[::-1, ::-1], sigma)[::-1, ::-1], blurred, rtol=5e-3)


@BOTH
@pytest.mark.parametrize(
    ("image", "sigma"), [(np.ones(5), 1), (np.ones((2, 2, 3)), 1), (np.ones((0, 4)), 1)]
)
def test_an_image_of_another_shape_raises_an_error(gaussian, image, sigma):
    with pytest.raises(ValueError, match="image"):
        gaussian(image, sigma)


@BOTH
@pytest.mark.parametrize("sigma", [0, -1, np.nan, np.inf])
def test_a_sigma_that_is_not_positive_raises_an_error(gaussian, sigma):
    with pytest.raises(ValueError, match="positive sigma"):
        gaussian(np.ones((4, 4)), sigma)


@pytest.mark.parametrize(("n", "k"), [(6, [1, 2, 1]), (9, [1, 4, 6, 4, 1]), (2, [0.5, 1, 0.5])])
def test_the_matrix_of_a_blur_is_the_blur(n, k):
    values = np.random.default_rng(0).random(n)
    expected = correlate1d(values, k, mode="reflect")
    assert np.allclose(blur.blur_matrix(n, k) @ values, expected, rtol=1e-5)
