"""hdrlab.tonemap.chiu: scale, clamp, smoothing passes, halos."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.ndimage import convolve, gaussian_filter
from support import laws

from hdrlab.core.steps import last
from hdrlab.errors import InputError
from hdrlab.fast import chiu as fast
from hdrlab.tonemap import chiu


def window(bright=1000.0):
    """Return a dim wall of 1 beside a bright window."""
    return np.where(np.arange(160) < 80, 1.0, bright).astype(np.float32) * np.ones(
        (100, 1), np.float32
    )


@given(level=st.floats(1e-9, 1e9), headroom=st.floats(1, 64))
def test_a_flat_scene_maps_to_one_over_headroom(level, headroom):
    assert np.allclose(
        chiu.tonemap(np.full((9, 12), level), headroom=headroom), 1 / headroom, rtol=1e-3
    )


def test_the_scale_is_one_over_k_times_the_blur():
    L = laws.scene()
    exact = 1 / (8 * gaussian_filter(L.astype(np.float64), 3))
    for scale in (chiu.scale, fast.scale):
        assert np.allclose(scale(L, headroom=8, sigma=3), exact, rtol=1e-3)


def test_the_clamp_limits_the_result_to_white():
    L = laws.scene()
    s = chiu.scale(L, headroom=1, sigma=3)
    assert np.any(s * L > 1) and np.all(chiu.clamp(s, L) * L <= 1 + 1e-6)
    assert np.array_equal(chiu.clamp(s, L)[s * L < 0.99], s[s * L < 0.99])


def test_a_pass_is_the_mean_with_weights_one_two_one_clamped():
    s = laws.scene((30, 40))
    L = 3 * laws.scene((30, 40), 1)
    kernel = np.outer([1, 2, 1], [1, 2, 1]) / 16
    assert np.allclose(
        chiu.smooth(s, L), np.minimum(convolve(s, kernel, mode="nearest"), 1 / L), rtol=1e-5
    )
    assert np.allclose(
        chiu.smooth(np.full((3, 4), 2.5, np.float32), np.zeros((3, 4), np.float32)), 2.5
    )


def test_every_state_is_its_equation():
    """The first pass starts from an image in which a single hot pixel does not set the scale."""
    L = laws.scene()
    states = list(chiu.tonemap_steps(L, headroom=2, sigma=4, passes=3))
    assert len(states) == 4
    limited = np.minimum(L, np.sort(L, axis=None)[-2])
    assert np.array_equal(states[0].s, chiu.clamp(chiu.scale(limited, headroom=2, sigma=4), L))
    for before, after in zip(states, states[1:], strict=False):
        assert np.array_equal(after.s, chiu.smooth(before.s, L))
        assert np.array_equal(after.Ld, after.s * L)
    assert np.allclose(last(states).Ld, chiu.tonemap(L, headroom=2, sigma=4, passes=3), atol=1e-6)


def test_passes_make_the_scale_smoother():
    L = laws.scene()
    rough = [
        np.abs(np.diff(np.log(state.s), axis=1)).mean()
        for state in chiu.tonemap_steps(L, headroom=1.5, sigma=4)
    ]
    assert np.all(np.diff(rough) < 0)


def test_an_edge_is_too_dark_on_its_dark_side_and_too_bright_on_the_bright_side():
    Ld = chiu.tonemap(window(), sigma=8, passes=0)[50]
    assert Ld[78] < 0.01 < Ld[20] and Ld[81] > 1.5 * Ld[140]
    assert Ld[20] == pytest.approx(1 / 8, rel=0.01) and Ld[140] == pytest.approx(1 / 8, rel=0.01)


def test_the_halo_is_negative_on_the_dark_side_positive_on_the_bright_and_zero_far_away():
    L = window()
    state = last(chiu.tonemap_steps(L, sigma=8, passes=0))
    halo = chiu.halo(L, state.s, sigma=8)[50]
    assert halo[78] < -5 and 0.5 < halo[81] < 1.1
    assert np.abs(halo[[10, 20, 140, 150]]).max() < 0.1


def test_a_smooth_scene_has_no_halo():
    x = np.linspace(0, 1, 200, dtype=np.float32)
    L = np.exp(2 * x) * np.ones((120, 1), np.float32)
    s = last(chiu.tonemap_steps(L, sigma=5)).s
    assert np.abs(chiu.halo(L, s, sigma=5))[20:-20, 20:-20].max() < 0.05


def test_a_hot_pixel_does_not_darken_its_neighbourhood():
    L = laws.scene()
    for tonemap in (chiu.tonemap, fast.tonemap):
        calm = tonemap(L)
        hot = tonemap(laws.hot_pixel(L))
        assert np.abs(hot - calm)[laws.hot_pixel(L) == L].max() < 0.1


def test_the_default_blur_keeps_the_contrast_of_two_halves_that_a_narrow_one_removes():
    """Why the default is 8 % of the image: outside the halo, textured halves keep some contrast."""
    texture = np.exp(0.2 * np.random.default_rng(0).standard_normal((96, 128)))
    L = np.where(np.arange(128) < 64, 1.0, 30.0) * texture
    narrow = chiu.tonemap(L, sigma=0.02 * 128)
    wide = chiu.tonemap(L, sigma=None)
    ratios = [np.median(Ld[:, 64:80]) / np.median(Ld[:, 40:56]) for Ld in (narrow, wide)]
    assert ratios[1] > 1.5 * ratios[0]
    assert chiu.choose_sigma(L) == pytest.approx(0.08 * 128)


def test_more_headroom_is_a_darker_picture():
    medians = [np.median(chiu.tonemap(laws.scene(), headroom=k)) for k in (2, 4, 8, 16)]
    assert np.all(np.diff(medians) < 0)


@pytest.mark.parametrize("knobs", [{"headroom": 0}, {"sigma": 0}, {"sigma": -1}, {"passes": -1}])
def test_invalid_parameters_raise_an_error(knobs):
    with pytest.raises(InputError):
        chiu.tonemap(np.ones((3, 3)), **knobs)
