"""hdrlab.tonemap.transfer: PQ and HLG, against their definitions and colour-science."""

import warnings

import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.errors import InputError
from hdrlab.tonemap import transfer

LIGHT = np.concatenate([[0], np.geomspace(1e-5, 10_000, 500)])
SIGNAL = np.linspace(0, 1, 1024)


def test_pq_meets_the_points_that_its_reports_print():
    """10 bits, full range: ITU-R BT.2408 puts reference white, 203 cd/m2, at 58 %."""
    assert transfer.pq(10_000) == 1 and transfer.pq(0) < 1e-6
    assert np.allclose(transfer.pq([100, 203, 1000]), [0.508, 0.581, 0.752], atol=5e-4)


def test_hlg_is_a_root_below_a_twelfth_and_meets_the_logarithm_with_one_slope():
    assert np.allclose(transfer.hlg([0, 1 / 48, 1 / 12, 1]), [0, 0.25, 0.5, 1], atol=1e-6)
    below, at, above = transfer.hlg(1 / 12 + 1e-5 * np.arange(-1, 2))
    assert (above - at) / (at - below) == pytest.approx(1, abs=1e-3)


@given(st.floats(0, 1))
def test_pq_and_hlg_signals_survive_a_round_trip(v):
    assert transfer.hlg(transfer.hlg_inverse(v)) == pytest.approx(v, abs=1e-6)
    if v > 1e-6:  # below it PQ is black
        assert transfer.pq(transfer.pq_inverse(v)) == pytest.approx(v, abs=1e-6)


def test_pq_and_hlg_rise_with_light():
    assert np.all(np.diff(transfer.pq(LIGHT)) > 0)
    assert np.all(np.diff(transfer.hlg(LIGHT / 10_000)) > 0)


def test_a_12_bit_step_of_pq_is_below_the_visible_threshold():
    """In a ramp, the eye sees steps of about 0.5 % in bright light, and of 1 % at 1 cd/m2 [Barten99;
    BT.2246].
    """
    FD = transfer.pq_inverse(np.linspace(0, 1, 4096))
    step = np.diff(FD) / np.maximum(FD[:-1], 1e-9)
    assert step[FD[:-1] > 1].max() < 0.007 and step[FD[:-1] > 100].max() < 0.004


def test_pq_spends_more_codes_on_the_dark_than_a_gamma():
    def gamma(FD):
        return (FD / 10_000) ** (1 / 2.4)

    dark = (0.1, 1)
    bright = (1000, 10_000)
    assert transfer.codes(transfer.pq, *dark) > 6 * transfer.codes(gamma, *dark)
    assert transfer.codes(gamma, *bright) > 2 * transfer.codes(transfer.pq, *bright)
    assert transfer.codes(transfer.pq, 0, 10_000, bits=12) == pytest.approx(4095, abs=0.1)


def test_a_brighter_display_has_a_steeper_gamma():
    assert transfer.display_light(0.1) == pytest.approx(1000 * 0.1**1.2)
    assert transfer.display_light(0.1, peak=4000) / 4000 < transfer.display_light(0.1) / 1000
    assert transfer.display_light(1, peak=4000) == 4000


@pytest.mark.parametrize("peak", [400, 700, 1000, 2000])
def test_hlg_gamma_is_the_line_of_bt2100_in_its_range(peak):
    assert transfer.system_gamma(peak) == pytest.approx(1.2 + 0.42 * np.log10(peak / 1000))


@pytest.mark.parametrize("peak", [1, 50, 100, 399, 2001, 4000, 10_000])
def test_hlg_gamma_is_a_power_of_the_peak_outside_of_the_range(peak):
    """BT.2390: 11.1 % for each doubling.

    It is positive for every display, and black stays black.
    """
    assert transfer.system_gamma(peak) == pytest.approx(1.2 * (peak / 1000) ** np.log2(1.111))
    FD = transfer.display_light(np.linspace(0, 1, 50), peak=peak)
    assert FD[0] == 0 and np.all(np.diff(FD) > 0) and FD[-1] == pytest.approx(peak)


def test_hlg_gamma_has_no_large_step_at_the_ends_of_the_range():
    for end in transfer.LINE_PEAKS:
        below = transfer.system_gamma(end * 0.999)
        above = transfer.system_gamma(end * 1.001)
        assert above == pytest.approx(below, abs=0.015)


@pytest.mark.parametrize("peak", [0, -100, np.nan, np.inf])
def test_displays_without_light_are_rejected(peak):
    with pytest.raises(InputError, match="cd/m2"):
        transfer.display_light(0.5, peak=peak)


@pytest.mark.papers
def test_pq_and_hlg_agree_with_colour_science():
    models = pytest.importorskip("colour.models")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it takes the logarithm of what it then leaves out
        pairs = [
            (transfer.pq(LIGHT), models.eotf_inverse_ST2084(LIGHT)),
            (transfer.pq_inverse(SIGNAL), models.eotf_ST2084(SIGNAL)),
            (transfer.hlg(SIGNAL), models.oetf_BT2100_HLG(SIGNAL)),
            (transfer.hlg_inverse(SIGNAL), models.oetf_inverse_BT2100_HLG(SIGNAL)),
            (transfer.display_light(SIGNAL, peak=2000), models.ootf_BT2100_HLG(SIGNAL, L_W=2000)),
        ]
    for ours, theirs in pairs:
        assert np.allclose(ours, theirs, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(
    "function", [transfer.pq, transfer.pq_inverse, transfer.hlg, transfer.hlg_inverse]
)
@pytest.mark.parametrize("value", [-0.01, 10_001, np.nan, np.inf])
def test_light_and_signals_out_of_range_raise_an_error(function, value):
    with pytest.raises(ValueError, match=r"values in 0 \.\.\. "):
        function([0.5, value])
