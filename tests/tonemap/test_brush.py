"""hdrlab.tonemap.brush: histogram equalization of a window, the clipped histogram, the lens."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from support import laws

from hdrlab.core.colour import decode_srgb, encode_srgb
from hdrlab.errors import InputError
from hdrlab.tonemap import brush


def test_without_a_limit_all_display_codes_are_equally_frequent():
    codes = encode_srgb(brush.equalise(laws.scene(), limit=np.inf))
    assert np.abs(np.sort(codes, axis=None) - np.linspace(0, 1, codes.size)).max() < 0.01


def test_limit_1_gives_the_plain_logarithm():
    L = laws.scene()
    low, high = brush.find_range(L)
    plain = np.clip(np.log(L / low) / np.log(high / low), 0, 1)
    assert np.allclose(brush.equalise(L, limit=1), decode_srgb(plain), atol=0.02)


@given(limit=st.floats(1, 50), seed=st.integers(0, 100))
def test_a_clipped_histogram_keeps_its_sum_and_its_limit(limit, seed):
    h = np.random.default_rng(seed).dirichlet(np.full(64, 0.1))
    g = brush.clip_histogram(h, limit=limit)
    assert g.sum() == pytest.approx(1) and g.max() <= limit / 64 + 1e-12 and g.min() >= -1e-12


def test_p_runs_from_zero_to_one():
    P = brush.cumulative(np.full(10, 0.1))
    assert P[0] == 0 and P[-1] == pytest.approx(1) and np.allclose(np.diff(P), 0.1) and P.max() <= 1


def test_the_histogram_counts_values_out_of_range_in_the_end_bins():
    t = brush.bin_position(np.float32([[0.01, 1.5, 50, 5000]]), 1, 100, 2)
    h = brush.histogram(t, bins=2)
    assert h.tolist() == [0.5, 0.5]


def test_noise_of_a_flat_wall_is_not_stretched():
    """Without a minimum range, noise of one percent would be stretched over the whole display."""
    noisy = 5 * (1 + 0.01 * np.random.default_rng(0).standard_normal((80, 80)))
    P = encode_srgb(brush.equalise(noisy.astype(np.float32)))
    assert np.ptp(P) < 0.5 and abs(np.median(P) - 0.5) < 0.1


def test_the_lens_shows_detail_of_a_dark_corner_that_the_global_operator_hides():
    L = np.full((200, 300), 1000.0)
    L[:60, :60] = 0.01 * np.where(np.indices((60, 60)).sum(axis=0) % 8 < 4, 1.0, 1.5)
    whole = brush.tonemap(L)[:60, :60]
    seen = brush.lens(L, (30, 30), size=60)
    assert np.ptp(whole) < 0.1 < 0.3 < np.ptp(seen)


@given(
    y=st.floats(-50, 250),
    x=st.floats(-50, 350),
    size=st.integers(1, 260),
    magnification=st.integers(1, 8),
)
def test_the_lens_stays_inside_the_picture(y, x, size, magnification):
    L = laws.scene((150, 240))
    magnification = min(magnification, size)
    seen = brush.lens(L, (y, x), size=size, magnification=magnification)
    side = -(-size // magnification)
    assert seen.shape == tuple(min(size, magnification * min(side, n)) for n in L.shape)
    assert np.all((seen >= 0) & (seen <= 1)) and seen.dtype == np.float32


def test_the_window_is_centered_and_shifted_inward_at_the_edge():
    assert brush.place_window((100, 200), (50, 80), 20) == (slice(40, 60), slice(70, 90))
    assert brush.place_window((100, 200), (0, 199), 20) == (slice(0, 20), slice(180, 200))
    assert brush.place_window((10, 200), (5, 100), 20) == (slice(0, 10), slice(90, 110))


def test_magnification_repeats_the_pixels_of_the_window():
    L = laws.scene()
    small = brush.lens(L, (40, 60), size=20)
    large = brush.lens(L, (40, 60), size=60, magnification=3)
    assert np.array_equal(large, small.repeat(3, axis=0).repeat(3, axis=1))


def test_a_lens_over_the_whole_image_equals_tonemap():
    L = laws.scene((64, 64))
    assert np.array_equal(brush.lens(L, (32, 32), size=64), brush.tonemap(L))


def test_light_outside_the_window_does_not_matter():
    L = laws.scene()
    changed = L.copy()
    changed[60:] = 1e9
    assert np.array_equal(brush.lens(L, (25, 60), size=40), brush.lens(changed, (25, 60), size=40))


@pytest.mark.parametrize("limit", [1, 2, np.inf])
def test_every_limit_obeys_the_laws(limit):
    for law in (*laws.ALWAYS, laws.monotone, laws.exposure):
        law(lambda L: brush.tonemap(L, limit=limit))


@pytest.mark.parametrize("knobs", [{"bins": 0}, {"limit": 0.5}, {"limit": np.nan}])
def test_invalid_parameters_raise_an_error(knobs):
    for view in (brush.tonemap, lambda L, **knobs: brush.lens(L, (1, 1), **knobs)):
        with pytest.raises(ValueError, match="at least 1 bin"):
            view(np.ones((3, 3)), **knobs)


def test_invalid_lens_parameters_raise_an_error():
    for knobs in ({"size": 0}, {"magnification": 0}, {"size": 4, "magnification": 5}):
        with pytest.raises(ValueError, match="magnification"):
            brush.lens(np.ones((9, 9)), (4, 4), **knobs)
    with pytest.raises(ValueError, match="luminance"):
        brush.lens(np.ones((9, 9, 3)), (4, 4), size=4)


def test_a_histogram_counts_every_pixel_once():
    """Compared with a plain loop, in which each pixel contributes to its two nearest bins."""
    L = np.maximum(laws.scene((101, 40)), 1e-3)
    bins = 16
    t = np.clip((np.log(L) - np.log(0.01)) * bins / np.log(1e4) - 0.5, 0, bins - 1).ravel()
    plain = [np.maximum(1 - np.abs(t - j), 0).sum() / t.size for j in range(bins)]
    h = brush.histogram(brush.bin_position(L, 0.01, 100, bins), bins)
    assert np.allclose(h, plain, atol=1e-4) and h.sum() == pytest.approx(1)


def test_the_range_is_at_least_one_stop():
    low, high = brush.find_range(np.full((20, 20), 3.0, np.float32))
    assert high / low == pytest.approx(2) and low * high == pytest.approx(9)
    wide = np.repeat(np.float32([1, 5, 50]), 200).reshape(20, 30)
    assert brush.find_range(wide) == pytest.approx((1, 50), rel=0.01)


@pytest.mark.parametrize("centre", [(1,), (1, 2, 3), (np.nan, 2), (np.inf, 2)])
def test_a_center_outside_the_image_raises_an_error(centre):
    with pytest.raises(InputError, match="centre"):
        brush.lens(np.ones((9, 9)), centre, size=4)
