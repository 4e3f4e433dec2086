"""hdrlab.calibration.matching: simulated screens, which simulated readers match by eye."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from numpy.polynomial.polynomial import polyval

from hdrlab.calibration import matching
from hdrlab.calibration.matching import Screen
from hdrlab.errors import InputError

GAMMAS = (1.8, 2.0, 2.2, 2.4, 2.6, 2.8)
BLACKS = (0.0005, 0.002, 0.005, 0.01, 0.03)
SLIDER = np.arange(1, 64 * 16) / 16 / 255  # sixteenths of a code, as the figure has them
CODES = np.arange(1, 255) / 255


def match(screen, *, threshold=0.02, gray_error=0.0, dark_error=0.0):
    """Return gray and dark as a reader sets them who sees the light of a screen."""
    rows = matching.screen_light([0, 1], screen).mean()
    grays = matching.screen_light(CODES, screen)
    gray = CODES[np.argmin(np.abs(grays - rows * (1 + gray_error)))]
    black = matching.screen_light(0, screen)
    patches = (1 - screen.black) * matching.dithered_light(SLIDER, screen.gamma)
    is_visible = patches >= threshold * black * (1 + dark_error)
    return gray, SLIDER[np.argmax(is_visible)]


@pytest.mark.parametrize("gamma", GAMMAS)
@pytest.mark.parametrize("black", BLACKS)
def test_gamma_and_stops_of_simulated_screens_are_recovered_within_ten_percent(gamma, black):
    """A reader errs by 1 % in the gray, as one who sets it a few times, and by 10 % at the threshold.

    The black as a part of white is only recovered within half of its value.
    """
    rng = np.random.default_rng(7)
    screen = Screen(gamma, black)
    gamma_errors = []
    stops_errors = []
    black_errors = []
    for gray_error, dark_error in rng.normal(0, [0.01, 0.1], (200, 2)):
        found = matching.measure(*match(screen, gray_error=gray_error, dark_error=dark_error))
        gamma_errors.append(abs(found.gamma / gamma - 1))
        stops_errors.append(abs(found.stops / screen.stops - 1))
        black_errors.append(abs(found.black / black - 1))
    assert np.quantile(gamma_errors, 0.95) < 0.05  # the guide states these three numbers
    assert np.quantile(stops_errors, 0.95) < 0.1
    assert np.quantile(black_errors, 0.95) < 0.5


@given(gamma=st.floats(1.5, 3), black=st.floats(0.0005, 0.2))
def test_exact_matches_give_the_screen_back(gamma, black):
    gray = 0.5 ** (1 / gamma)
    light = 0.02 * black / (1 - black)
    codes = np.arange(256) / 255
    dark = np.interp(light, codes**gamma, codes)
    found = matching.measure(gray, dark)
    assert found.gamma == pytest.approx(gamma)
    assert found.black == pytest.approx(black)


@given(
    fraction=st.floats(0.05, 0.95),
    gamma=st.floats(1.5, 3),
    black=st.floats(0, 0.3, exclude_max=True),
)
def test_no_match_of_a_mixture_depends_on_the_black(fraction, gamma, black):
    """The rows may hold any fraction of white: the black adds the same light to both sides."""
    screen = Screen(gamma, black)
    mixture = (1 - fraction) * matching.screen_light(0, screen) + fraction
    assert matching.screen_light(fraction ** (1 / gamma), screen) == pytest.approx(mixture)


@pytest.mark.parametrize("threshold", [0.01, 0.014, 0.02, 0.03, 0.04])
@pytest.mark.parametrize("black", BLACKS)
def test_the_range_of_stops_contains_the_truth_for_eyes_of_one_to_four_percent(threshold, black):
    screen = Screen(2.2, black)
    gray = 0.5 ** (1 / 2.2)
    _, dark = match(screen, threshold=threshold)
    fewest, most = matching.stops_range(gray, dark)
    slider_step = 0.2  # stops of light, on the darkest screens
    assert fewest - slider_step <= screen.stops <= most + slider_step


def test_thresholds_are_those_of_the_dicom_gray_scale_function():
    """DICOM PS3.14, table B-1 by its formula: one just noticeable difference at a luminance."""
    numerator = [-1.3011877, 8.0242636e-2, 1.3646699e-1, -2.5468404e-2, 1.3635334e-3]
    denominator = [1, -2.5840191e-2, -1.0320229e-1, 2.8745620e-2, -3.1978977e-3, 1.2992634e-4]
    x = np.log(np.arange(1, 1024))
    luminance = 10 ** (polyval(x, numerator) / polyval(x, denominator))
    w = np.diff(luminance) / luminance[:-1]
    low, high = matching.THRESHOLD_RANGE
    at = np.interp([20, 2, 0.3], luminance[:-1], w)
    assert np.allclose(at, [low, matching.THRESHOLD, high], rtol=0.1)


def test_light_goes_through_encode_and_the_screen_unchanged():
    light = np.linspace(0, 1, 50)
    for gamma in GAMMAS:
        v = matching.encode(light, gamma) / 255
        shown = matching.screen_light(v, Screen(gamma, 0.0))
        half_a_code = gamma * 0.5 / 255
        assert np.abs(shown - light).max() <= 1.01 * half_a_code


def test_the_setting_is_the_measured_contrast_to_half_a_stop_and_stays_in_its_range():
    for stops in np.linspace(4, 12, 50):
        setting = matching.setting_of_contrast(Screen(2.2, 2**-stops))
        assert abs(np.log2(setting) - stops) <= 0.25 + 1e-9
    assert matching.setting_of_contrast(Screen(2.2, 0.5)) == 2**4
    assert matching.setting_of_contrast(Screen(2.2, 1e-6)) == 2**12


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ((0.7, 0.0), "dark"),
        ((1.0, 0.1), "gray"),
        ((0.1, 0.2), "dark"),
        ((np.nan, 0.1), "gray"),
    ],
)
def test_measure_rejects_impossible_matches(arguments, named):
    with pytest.raises(InputError, match=named):
        matching.measure(*arguments)
    with pytest.raises(InputError, match="threshold"):
        matching.measure(0.7, 0.1, threshold=0)
    with pytest.raises(InputError, match="gamma"):
        matching.encode(0.5, 0)
