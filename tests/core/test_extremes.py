"""Robust extremes: a single odd pixel does not set the scale, and black has no logarithm."""

import numpy as np
import pytest

from hdrlab.core import extremes

RAMP = np.linspace(1, 2, 10_000).reshape(100, 100).astype(np.float32)


def test_a_hot_pixel_does_not_set_the_maximum_and_a_dead_one_not_the_minimum():
    L = RAMP.copy()
    L[3, 4] = 1e6
    L[50, 60] = 1e-6
    assert extremes.robust_maximum(L) == pytest.approx(2, rel=1e-3)
    assert extremes.robust_minimum(L) == pytest.approx(1, rel=1e-3)


def test_cut_is_the_fraction_of_positive_pixels_beyond_the_extreme():
    L = RAMP.copy()
    L[:50] = 0  # half of the picture is black
    positive = L[L > 0]
    assert np.mean(positive > extremes.robust_maximum(L, cut=0.1)) == pytest.approx(0.1, abs=0.001)
    assert np.mean(positive < extremes.robust_minimum(L, cut=0.1)) == pytest.approx(0.1, abs=0.001)
    assert extremes.positive_median(L) == pytest.approx(np.median(positive), rel=1e-3)


def test_extremes_of_a_large_picture_are_near_the_exact_quantiles():
    L = np.random.default_rng(0).lognormal(0, 2, (900, 1100)).astype(np.float32)
    assert extremes.robust_maximum(L, cut=0.1) == pytest.approx(np.quantile(L, 0.9), rel=0.03)
    assert extremes.robust_minimum(L, cut=0.1) == pytest.approx(np.quantile(L, 0.1), rel=0.03)


def test_extremes_of_a_black_picture_are_0():
    black = np.zeros((3, 4), np.float32)
    assert extremes.robust_maximum(black) == extremes.robust_minimum(black) == 0
    assert extremes.positive_median(black) == 0


def test_extremes_do_not_depend_on_the_unit_of_light():
    assert extremes.robust_maximum(64 * RAMP) == 64 * extremes.robust_maximum(RAMP)
    assert extremes.decades(64 * RAMP) == pytest.approx(extremes.decades(RAMP))


def test_decades_are_the_powers_of_ten_between_dark_and_bright():
    L = np.geomspace(0.01, 1000, 2001).reshape(3, 667)
    assert extremes.decades(L, tail=0) == pytest.approx(5)
    assert extremes.decades(L, tail=0.1) == pytest.approx(4, abs=0.01)


@pytest.mark.parametrize("tail", [-0.1, 0.5])
def test_decades_refuse_a_tail_that_leaves_no_middle(tail):
    with pytest.raises(ValueError, match=str(tail)):
        extremes.decades(RAMP, tail=tail)


def test_decades_refuse_a_scene_without_light():
    with pytest.raises(ValueError, match="zeros"):
        extremes.decades(np.zeros((2, 2)))
