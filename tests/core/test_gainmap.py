"""hdrlab.core.gainmap: the equations of ISO 21496-1, by closed forms and round trips."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from hdrlab.core import gainmap

RNG = np.random.default_rng(0)
SDR = RNG.uniform(0, 1, (20, 30, 3))
HDR = RNG.uniform(0, 8, (20, 30, 3))


def test_log_gain_is_in_stops():
    sdr = np.array([0.25, 0.25, 1])
    hdr = np.array([0.25, 0.5, 8])
    assert np.allclose(gainmap.log_gain(sdr, hdr, k=(0, 0)), [0, 1, 3])
    assert gainmap.log_gain(np.array(0.0), np.array(0.0)) == 0  # black has no gain


def test_the_gain_map_runs_from_0_at_the_smallest_gain_to_1_at_the_largest_and_is_clipped():
    sdr = np.full(5, 1.0)
    hdr = 2.0 ** np.array([-3, -1, 0, 3, 5])
    assert np.allclose(gainmap.gain_map(sdr, hdr, -1, 3, k=(0, 0)), [0, 0, 0.25, 1, 1])
    assert np.allclose(gainmap.gain_map(sdr, hdr, -1, 3, gamma=2, k=(0, 0)), [0, 0, 0.0625, 1, 1])


@pytest.mark.parametrize("gamma", [0.5, 1.0, 2.2])
@pytest.mark.parametrize("k", [(1 / 64, 1 / 64), (1e-3, 1e-2)])
def test_applying_the_gain_map_restores_the_hdr_image(gamma, k):
    low = np.min(gainmap.log_gain(SDR, HDR, k=k), axis=(0, 1))
    high = np.max(gainmap.log_gain(SDR, HDR, k=k), axis=(0, 1))
    g = gainmap.gain_map(SDR, HDR, low, high, gamma=gamma, k=k)
    assert np.allclose(gainmap.apply_gain(SDR, g, low, high, gamma=gamma, k=k), HDR)


def test_weight_0_keeps_the_sdr_image_and_black_stays_black():
    g = RNG.uniform(0, 1, SDR.shape)
    assert np.allclose(gainmap.apply_gain(SDR, g, -2, 3, W=0), SDR)
    low = -2.0
    high = 3.0
    nothing = gainmap.gain_map(np.zeros(3), np.zeros(3), low, high)
    assert all(
        np.allclose(gainmap.apply_gain(np.zeros(3), nothing, low, high, W=W), 0)
        for W in (0, 0.3, 1)
    )


@given(st.floats(0.1, 100), st.floats(1.1, 100))
def test_the_weight_rises_with_the_screen_headroom_and_is_at_most_1(screen, headroom):
    W = gainmap.weight(screen, headroom)
    assert 0 <= W <= 1 and W <= gainmap.weight(2 * screen, headroom)
    assert gainmap.weight(headroom, headroom) == 1 and gainmap.weight(1, headroom) == 0


def test_a_screen_of_half_the_stops_shows_the_square_root_of_the_ratio():
    sdr = np.ones(1)
    assert gainmap.apply_gain(sdr, sdr, 0, 4, W=gainmap.weight(4, 16), k=(0, 0)) == pytest.approx(4)


def test_a_few_odd_pixels_do_not_widen_the_range():
    G = RNG.uniform(-1, 2, (100, 100, 3))
    G[0, 0] = 30
    low, high = gainmap.find_range(G)
    assert low.shape == high.shape == (3,) and np.all(high < 2.01) and np.all(low > -1.01)
    low, high = gainmap.find_range(np.zeros((4, 4)))  # a range is never empty
    assert high > low == 0


def test_light_gets_the_log_average_of_the_picture_in_any_unit():
    E = RNG.lognormal(0, 2, (40, 60, 3)).astype(np.float32)
    sdr = (E / (1 + E)).astype(np.float32)
    hdr = gainmap.expose(E, sdr, 4.0)
    assert hdr.max() == 4 and np.allclose(gainmap.expose(1000 * E, sdr, 4.0), hdr, rtol=1e-4)
    L = gainmap.expose(E, sdr, np.inf) @ [0.2126, 0.7152, 0.0722]
    Ld = sdr @ [0.2126, 0.7152, 0.0722]
    assert np.log(L).mean() == pytest.approx(np.log(Ld).mean(), abs=1e-4)
    assert np.all(gainmap.expose(np.zeros((2, 2, 3)), np.zeros((2, 2, 3), np.float32), 4.0) == 0)
    assert np.all(gainmap.expose(np.zeros((2, 2)), np.zeros((2, 2), np.float32), 4.0) == 0)


def test_lamps_beyond_the_headroom_keep_their_color():
    """The chapel's flame (92.9, 42.1, 13.0) is as red at the headroom as it is in the scene."""
    E = np.full((40, 60, 3), 0.5, np.float32)
    flame = (92.9, 42.1, 13.0)
    E[5, 7] = flame
    E[9, 9] = (7.9, 3.0, 1.0)
    hdr = gainmap.expose(E, E, 8.0)
    assert hdr[5, 7] == pytest.approx(8 * np.array(flame) / 92.9, rel=1e-4)
    assert hdr.max() <= 8
    assert np.allclose(hdr[9:], E[9:])  # what is within the headroom stays


def test_headroom_of_1_has_no_gain_to_show():
    assert gainmap.weight(1, 1) == 0 and gainmap.weight(4, 1) == 0
