"""hdrlab.radiance.pu21 against the authors' figures and MATLAB's SSIM; damage lowers a score."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.ndimage import correlate1d, gaussian_filter

from hdrlab.radiance import pu21

SHAPE = (48, 64)


def reference(seed=0, shape=(*SHAPE, 3)):
    """Return radiance of some decades with detail at all scales."""
    rng = np.random.default_rng(seed)
    spatial = (2, 2, 0)[: len(shape)]
    return np.exp(6 * gaussian_filter(rng.standard_normal(shape), spatial)).astype(np.float32)


def test_100_candela_per_square_meter_gives_256_as_the_authors_promise():
    """This makes PU-PSNR on an ordinary display similar to the PSNR of its pixel values."""
    assert pu21.encode(100) == pytest.approx(256.4, abs=0.05)


def test_the_range_of_values_is_the_published_one():
    """The Video Quality Experts Group tabulates it in its siti-tools, for `banding_glare`."""
    V = pu21.encode([pu21.MIN_LUMINANCE, pu21.MAX_LUMINANCE])
    assert V == pytest.approx([5.4705e-10, 595.3939], rel=1e-4)


def test_luminance_outside_of_the_range_is_clipped():
    assert np.array_equal(pu21.encode([0, 1e6]), pu21.encode([0.005, 10_000]))


def test_a_brighter_light_gets_a_larger_value_and_decoding_finds_it_again():
    Y = np.geomspace(0.005, 10_000, 10_000)
    V = pu21.encode(Y)
    assert np.all(np.diff(V) > 0)
    assert np.allclose(pu21.decode(V), Y, rtol=1e-9)


def test_one_more_candela_is_worth_less_on_a_brighter_ground():
    Y = np.geomspace(0.01, 9000, 100)
    step = pu21.encode(Y + 0.01) - pu21.encode(Y)
    assert np.all(np.diff(step) < 0)


def test_pu_psnr_is_a_psnr_with_a_peak_of_256():
    E = reference(1)
    V = pu21.encode(20.0 * E)
    V_reference = pu21.encode(20.0 * reference())
    by_hand = 20 * np.log10(256 / np.sqrt(np.mean((V - V_reference) ** 2)))
    assert pu21.psnr(E, reference(), luminance_of_unit=20) == pytest.approx(by_hand)


def test_equal_maps_have_the_best_scores():
    E = reference()
    assert pu21.psnr(E, E, luminance_of_unit=1) == np.inf
    assert pu21.ssim(E, E, luminance_of_unit=1) == pytest.approx(1)


def matlab_ssim(x, y):
    """Return MATLAB's ssim(x, y, 'DynamicRange', 256): see its documentation for the settings."""
    window = np.exp(-0.5 * (np.arange(-5, 6) / 1.5) ** 2)
    window /= window.sum()

    def mean(image):
        rows = correlate1d(image, window, axis=0, mode="nearest")
        return correlate1d(rows, window, axis=1, mode="nearest")

    C1 = (0.01 * 256) ** 2
    C2 = (0.03 * 256) ** 2
    mx = mean(x)
    my = mean(y)
    sxx = mean(x * x) - mx**2
    syy = mean(y * y) - my**2
    sxy = mean(x * y) - mx * my
    similarity = (2 * mx * my + C1) * (2 * sxy + C2)
    return (similarity / ((mx**2 + my**2 + C1) * (sxx + syy + C2))).mean()


@pytest.mark.parametrize("shape", [(48, 64), (12, 11), (5, 3)])
def test_pu_ssim_is_that_of_matlab_which_the_authors_use(shape):
    x = reference(0, shape)
    y = reference(1, shape)
    expected = matlab_ssim(*(pu21.encode(50 * E.astype(float)) for E in (x, y)))
    assert pu21.ssim(x, y, luminance_of_unit=50) == pytest.approx(expected, abs=1e-9)


def test_the_unit_changes_the_score_and_scaling_map_and_unit_together_does_not():
    E = reference()
    darker = 0.9 * E
    score = pu21.psnr(darker, E, luminance_of_unit=10)
    assert pu21.psnr(4 * darker, 4 * E, luminance_of_unit=2.5) == pytest.approx(score, rel=1e-5)
    assert pu21.psnr(darker, E, luminance_of_unit=0.1) > score + 3


@given(s=st.floats(0.01, 100))
def test_a_fitted_exposure_undoes_a_factor(s):
    E = reference()
    assert pu21.fit_exposure(E / s, E) == pytest.approx(s, rel=1e-5)


def test_a_fitted_exposure_ignores_a_few_clipped_pixels_and_black_ones():
    E = reference()
    estimate = E / 3
    estimate[:4] = 0
    estimate[-4:] = 100
    assert pu21.fit_exposure(estimate, E) == pytest.approx(3, rel=1e-5)


@pytest.mark.parametrize("score", [pu21.psnr, pu21.ssim])
@pytest.mark.parametrize(
    "damage",
    [
        lambda E, k: E * (1 + 0.1 * k),
        lambda E, k: gaussian_filter(E, (k, k, 0)),
        lambda E, k: E * np.exp(0.1 * k * np.random.default_rng(0).standard_normal(E.shape)),
        lambda E, k: np.minimum(E, np.quantile(E, 1 - 0.1 * k)),
    ],
    ids=["too bright", "blurred", "noisy", "clipped"],
)
def test_more_damage_gives_a_lower_score(score, damage):
    E = reference()
    scores = [score(damage(E, k), E, luminance_of_unit=30) for k in range(4)]
    assert np.all(np.diff(scores) < 0)


def test_pu_ssim_does_not_see_colors_and_pu_psnr_does():
    E = reference()
    L = E @ np.float32([0.2126, 0.7152, 0.0722])
    gray = np.stack([L] * 3, axis=-1)
    assert pu21.ssim(gray, E, luminance_of_unit=30) == pytest.approx(1, abs=1e-4)
    assert pu21.psnr(gray, E, luminance_of_unit=30) < 40


@pytest.mark.parametrize("score", [pu21.psnr, pu21.ssim])
@pytest.mark.parametrize(
    ("E", "unit", "message"),
    [
        (np.ones((4, 5)), None, "relative"),
        (np.ones((4, 5)), 0, "above 0"),
        (np.ones((4, 5)), np.inf, "finite"),
        (np.ones((4, 5)), 1e-6, "luminance_of_unit right"),
        (np.ones((4, 5)), 1e6, "luminance_of_unit right"),
        (np.ones((5, 4)), 1, "one shape"),
        (-np.ones((4, 5)), 1, "negative"),
    ],
)
def test_maps_that_have_no_score_raise_an_error(score, E, unit, message):
    with pytest.raises(ValueError, match=message):
        score(E, np.ones((4, 5)), luminance_of_unit=unit)


def test_maps_without_a_common_pixel_with_light_cannot_be_fitted():
    with pytest.raises(ValueError, match="light in both"):
        pu21.fit_exposure([[1.0, 0.0]], [[0.0, 1.0]])
