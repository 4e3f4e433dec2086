"""Weighting functions: symmetric, 1 in the middle, 0 at both ends."""

import numpy as np
import pytest

from hdrlab.core import weights

TABLES = [weights.hat, weights.gaussian, weights.flat]


@pytest.mark.parametrize("n", [256, 65536])
@pytest.mark.parametrize("table", TABLES)
def test_a_weight_is_symmetric_within_0_and_1_and_0_at_both_ends_alone(table, n):
    w = table(n)
    assert w.shape == (n,) and np.allclose(w, w[::-1])
    assert w[0] == w[-1] == 0 and np.all(w[1:-1] > 0) and np.isclose(w.max(), 1, atol=1e-3)


@pytest.mark.parametrize("table", TABLES)
def test_weights_of_16_bits_equal_those_of_8_at_common_levels(table):
    ratio = table(65536)[257:-257:257] / table(256)[1:-1]
    assert np.allclose(ratio, ratio[0], rtol=1e-9)


def test_the_hat_is_the_papers_triangle():
    w = weights.hat()
    assert np.allclose(w[:128] * 127, np.arange(128))
    assert np.allclose(w[128:] * 127, np.arange(127, -1, -1))


def test_the_gaussian_falls_to_one_over_e_halfway():
    n = 65537  # has a level in the middle and halfway
    assert np.isclose(
        weights.gaussian(n)[n // 4], (np.exp(-1) - np.exp(-4)) / (1 - np.exp(-4)), atol=1e-6
    )


def test_a_cut_zeroes_what_lies_beyond_and_nothing_else():
    w = weights.cut(weights.flat(), above=0.98, below=0.1)
    assert np.flatnonzero(w)[[0, -1]].tolist() == [26, 249]  # 25.5 / 255 and 249.9 / 255
    assert np.all(w[26:250] == 1)


def test_a_level_at_the_cut_itself_stays():
    assert weights.cut(np.ones(5), above=0.75, below=0.25).tolist() == [0, 1, 1, 1, 0]


def test_cut_does_not_change_its_argument():
    w = weights.hat()
    weights.cut(w, above=0.5)
    assert np.array_equal(w, weights.hat())


@pytest.mark.parametrize(
    ("above", "below"), [(0.2, 0.5), (1.1, 0), (0.9, -0.1), (0.5, 0.5), (np.nan, 0)]
)
def test_a_cut_that_leaves_nothing_raises_an_error(above, below):
    with pytest.raises(ValueError, match="0 <= below < above <= 1"):
        weights.cut(weights.hat(), above=above, below=below)


def test_make_monotone_levels_falls_and_keeps_a_rising_curve():
    g = np.array([-3.0, -1, -2, 0, 2, 1, 3])  # the middle is index 3
    assert weights.make_monotone(g).tolist() == [-3, -2, -2, 0, 2, 2, 3]
    assert np.array_equal(weights.make_monotone(np.sort(g)), np.sort(g))


def test_the_second_differences_of_a_line_are_0_and_those_of_a_parabola_its_weights():
    w = np.array([0.0, 1, 3, 2, 0])
    z = np.arange(5.0)
    assert np.allclose(weights.second_differences(w, 10) @ (3 * z + 1), 0)
    assert np.allclose(weights.second_differences(w, 10) @ z**2, [20, 60, 40])


def test_snr_weights_near_the_top_use_the_slope_up_to_the_top():
    """The slope of f = z^2 from a to b is a + b: for level 254, whose window ends at 255, it is 250 +
    255.
    """
    w = weights.snr(2 * np.log(np.maximum(np.arange(256), 1e-3) / 255))
    slope = {254: 250 + 255, 253: 249 + 255, 128: 124 + 132}
    share = {z: z**2 / across for z, across in slope.items()}
    assert w[254] / w[128] == pytest.approx(share[254] / share[128], rel=1e-5)
    assert w[253] / w[128] == pytest.approx(share[253] / share[128], rel=1e-5)


def test_the_weights_of_a_straight_response_grow_with_the_level():
    straight = np.log(np.maximum(np.arange(256), 0.5) / 128)
    w = weights.snr(straight)
    np.testing.assert_allclose(w[5:250], np.arange(5, 250) / 128, rtol=0.01)
    step = np.maximum.accumulate(
        np.log(np.where(np.arange(256) < 128, np.maximum(np.arange(256), 1), 128))
    )
    least = weights.snr(step, span=1, least=0.5)  # a flat piece counts as half as steep as the mean
    assert least[200] / least[100] == pytest.approx(128 / 100 * (255 / 127) / 0.5, rel=0.01)
