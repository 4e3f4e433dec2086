"""hdrlab.tonemap.drago: the logarithm whose base rises from 2 to 10, and its bias."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from test_tonemap_oracles import likeness, pfstmo, room

from hdrlab.tonemap import drago

BIASES = st.floats(0.5, 1)
RANGES = st.floats(1, 1e5)


@given(high=RANGES, bias=BIASES)
def test_black_stays_black_and_the_brightest_luminance_becomes_white(high, bias):
    assert drago.adaptive_log([0, high], 1, high, bias=bias) == pytest.approx([0, 1])


@given(high=RANGES)
def test_a_bias_of_1_is_the_common_logarithm(high):
    Lw = np.linspace(0, high, 50)
    expected = np.log10(Lw + 1) / np.log10(high + 1)
    assert np.allclose(drago.adaptive_log(Lw, 1, high, bias=1), expected)


@given(unit=st.floats(1e-6, 1e6))
def test_the_unit_of_luminance_cancels(unit):
    L = np.array([0.1, 3, 40])
    expected = drago.adaptive_log(L, 0.7, 50)
    assert np.allclose(drago.adaptive_log(unit * L, unit * 0.7, unit * 50), expected)


def test_halfway_the_base_is_2_plus_8_times_the_bias():
    for bias in (0.5, 0.85):
        Ld = drago.adaptive_log(50, 1, 100, bias=bias)
        assert Ld == pytest.approx(np.emath.logn(2 + 8 * bias, 51) / np.log10(101))


@given(b=st.floats(0.05, 0.95))
def test_the_bias_is_the_value_halfway(b):
    assert drago.bias_power([0, 0.5, 1], b) == pytest.approx([0, b, 1])


def test_dark_places_have_the_slope_of_the_logarithm_to_base_2():
    high = 1000.0
    slope = drago.adaptive_log(1e-12, 1, high) / 1e-12
    assert slope == pytest.approx(1 / (np.log(2) * np.log10(high + 1)), rel=0.01)


def test_a_smaller_bias_brightens_the_middle_tones():
    Lw = np.geomspace(0.01, 90, 30)
    curves = [drago.adaptive_log(Lw, 1, 100, bias=b) for b in (0.7, 0.85, 1)]
    assert np.all(curves[0] > curves[1]) and np.all(curves[1] > curves[2])


@pytest.mark.parametrize("bias", [0.7, 0.85])
def test_the_curve_overshoots_white_from_the_range_on_that_its_docstring_states(bias):
    limit = 10 ** (1.25 * np.log(0.5) / np.log(bias)) - 1
    for high, overshoots in ((limit / 1.1, False), (limit * 1.1, True)):
        Ld = drago.adaptive_log(np.geomspace(high / 100, high, 10_000), 1, high, bias=bias)
        assert (Ld.max() > 1 + 1e-9) == overshoots


def test_the_curve_equals_that_of_pfstools():
    """pfstools uses the maximum as white, and a log average with a floor of 1e-4."""
    L = room()
    Lwa = float(np.exp(np.log(L.astype(np.float64) + 1e-4).mean()))
    for bias in (0.7, 0.85):
        ours = np.clip(drago.adaptive_log(L, Lwa, float(L.max()), bias=bias), 0, 1)
        assert np.allclose(ours, pfstmo("pfstmo_drago03", L, "--bias", f"{bias}"), atol=1e-4)


def test_the_operator_is_like_that_of_pfstools_whose_white_is_the_maximum():
    comparison = likeness(drago.tonemap(room()), pfstmo("pfstmo_drago03", room()))
    assert comparison.ssim > 0.98 and comparison.correlation > 0.999, comparison


@pytest.mark.parametrize("bias", [0, -0.1, 1.01, np.nan, np.inf])
def test_a_bias_out_of_range_raises_an_error(bias):
    with pytest.raises(ValueError, match="bias"):
        drago.tonemap(np.ones((3, 3)), bias=bias)
