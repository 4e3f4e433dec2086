"""hdrlab.tonemap.ward: foveal image, trimmed histogram, ceiling, and the linear map for a wide display."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from support import laws

from hdrlab.core.colour import luminance
from hdrlab.core.steps import last
from hdrlab.io.maps import rgbe
from hdrlab.tonemap import ward

D = np.log(100)  # a display of 1 to 100 cd/m^2


def uneven(seed=0, bins=100):
    """Return a histogram with two peaks, as an interior with a window has."""
    b = np.linspace(0, 1, bins)
    noise = np.random.default_rng(seed).uniform(0.5, 1.5, bins)
    return np.round(
        noise * (2000 * np.exp(-80 * (b - 0.2) ** 2) + 500 * np.exp(-200 * (b - 0.85) ** 2) + 20)
    )


def test_the_foveal_image_is_the_mean_of_each_degree():
    L = np.arange(60 * 120, dtype=np.float32).reshape(60, 120)
    Lf = ward.foveal_image(L, field=60)
    assert Lf.shape == (30, 60)
    assert np.allclose(Lf, L.reshape(30, 2, 60, 2).mean(axis=(1, 3)), rtol=1e-6)


@settings(max_examples=30, deadline=None)
@given(height=st.integers(1, 90), width=st.integers(1, 90), field=st.floats(1, 200))
def test_any_picture_has_a_foveal_image_between_its_extremes(height, width, field):
    L = laws.scene((height, width))
    Lf = ward.foveal_image(L, field=field)
    assert max(Lf.shape) <= np.ceil(field) + 1
    assert Lf.min() >= L.min() * (1 - 1e-5) and Lf.max() <= L.max() * (1 + 1e-5)


def test_a_picture_smaller_than_its_field_is_its_own_foveal_image():
    assert np.array_equal(ward.foveal_image(laws.scene((20, 30)), field=60), laws.scene((20, 30)))


def test_the_histogram_counts_positive_pixels_and_clips_to_its_ends():
    h, db = ward.histogram(np.float32([[0, 1e-9, 1, 10, 99, 1e9]]), low=1, high=100, bins=2)
    assert h.tolist() == [2, 3] and db == pytest.approx(np.log(10))


def test_trimming_cuts_to_the_ceiling_without_redistributing():
    h = np.array([10.0, 70, 20])
    state = ward.trim(h, db=0.5, D=1.0)
    assert state.ceiling == 50 and state.h.tolist() == [10, 50, 20]
    assert state.trimmings == 20 and state.T == 100


def test_every_trim_computes_its_ceiling_from_the_previous_histogram():
    h = uneven()
    db = 0.07
    states = list(ward.adjust_steps(h, db, D))
    assert len(states) > 3 and np.array_equal(states[0].h, h)
    for before, after in zip(states, states[1:], strict=False):
        assert after.T == before.h.sum() and after.ceiling == pytest.approx(after.T * db / D)
        assert np.array_equal(after.h, np.minimum(before.h, after.ceiling))
        assert after.trimmings == pytest.approx(before.h.sum() - after.h.sum())


def test_the_trims_stop_at_the_first_below_the_tolerance():
    h = uneven()
    states = list(ward.adjust_steps(h, 0.07, D, tolerance=0.025))
    assert states[-1].trimmings < 0.025 * states[-1].T
    assert all(state.trimmings >= 0.025 * state.T for state in states[:-1])
    assert len(list(ward.adjust_steps(h, 0.07, D, tolerance=1e-6))) > len(states)


def test_a_range_smaller_than_the_displays_empties_the_histogram():
    """Then the sum of all ceilings is below T for every T."""
    h = uneven()
    db = 0.9 * D / 100
    state = last(ward.adjust_steps(h, db, D))
    assert state.h.sum() <= 0.025 * h.sum()


def test_p_is_the_cumulative_distribution_and_ends_at_one():
    state = ward.Trim(np.array([1.0, 2, 1]), np.inf, 4.0, 0.0)
    assert ward.cumulative(state).tolist() == [0, 0.25, 0.75, 1]


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 1000),
    decades=st.floats(0.01, 12),
    range=st.floats(1.1, 1e5),
    bins=st.integers(1, 300),
    field=st.floats(5, 90),
)
def test_no_contrast_exceeds_the_scenes(seed, decades, range, bins, field):
    """d ln Ld / d ln L <= 1 everywhere, and so L_d / L never rises [Battiato08 eq. 1.25]."""
    L = (10 ** (np.random.default_rng(seed).beta(0.7, 2, (40, 50)) * decades)).astype(np.float32)
    lnL, lnLd = ward.curve(L, black=1, white=range, bins=bins, field=field)
    slope = np.diff(lnLd) / np.diff(lnL)
    assert np.all(slope >= 0) and np.all(slope <= 1 + 1e-9)


def test_a_range_that_fits_the_display_is_mapped_linearly():
    rng = np.random.default_rng(1)
    L = rng.uniform(2, 40, (60, 80))
    Ld = ward.tonemap(L, black=1, white=100)
    light = Ld * 99 + 1  # cd/m^2
    assert np.ptp((light / L)[Ld < 0.99]) < 1e-4 and Ld.max() == 1


def chart():
    """Return a gray chart with few luminances, over 7 decades with its lamp and its darkest patch."""
    L = np.full((120, 160), 0.5)
    L[:, :80] = 0.3
    L[40:60, 20:40] = 0.05
    L[80:90, 100:110] = 1000
    L[20:30, 120:130] = 1e-4
    return L


def test_a_chart_with_few_brightnesses_is_not_black_beside_a_lamp():
    """The linear map would make it black: 0.5 of 1000 is less than one level of 256."""
    Ld = ward.tonemap(chart(), field=200)
    light = 99 * Ld + 1  # cd/m^2
    assert Ld[5, 100] > 0.05 and Ld.max() == pytest.approx(1, abs=1e-6)
    assert 1.2 < light[5, 100] / light[5, 10] < 0.5 / 0.3
    assert light[85, 105] / light[5, 100] > 5 and light[25, 125] < light[50, 30] < light[5, 10]


@pytest.mark.parametrize("white", [3.0, 10, 100, 1e4])
def test_fill_uses_the_whole_display_without_exaggerating_contrast(white):
    lnL, lnLd = ward.curve(chart().astype(np.float32), white=white, field=200)
    slope = np.diff(lnLd) / np.diff(lnL)
    assert slope.min() >= 0 and slope.max() <= 1 + 1e-9
    assert np.allclose(np.exp(lnLd[[0, -1]]), [1, white])


def test_a_tolerance_too_small_to_stop_early_leaves_no_black_unused():
    L = laws.scene()
    ends = [np.exp(ward.curve(L, tolerance=t)[1][[0, -1]]) for t in (0.025, 1e-9)]
    assert np.allclose(ends[1], [1, 100])
    assert 1 <= ends[0][0] < 1.13
    assert ends[0][1] == pytest.approx(100)


def test_without_a_ceiling_all_brightnesses_are_equally_frequent():
    """The formula itself, on a histogram that was not trimmed."""
    L = laws.scene((40, 50))
    low = float(L.min())
    high = float(L.max())
    h, db = ward.histogram(L, low=low, high=high, bins=1000)
    P = ward.cumulative(ward.Trim(h, np.inf, h.sum(), np.inf))
    at = np.interp(np.log(L), np.log(low) + db * np.arange(1001), P).ravel()
    assert np.abs(np.sort(at) - np.linspace(0, 1, at.size)).max() < 0.02


def test_tonemap_applies_the_same_curve_to_every_pixel():
    L = laws.scene()
    b, lnLd = ward.curve(L)
    plain = (np.exp(np.interp(np.log(L), b, lnLd)) - 1) / 99
    assert np.allclose(ward.tonemap(L), np.clip(plain, 0, 1), atol=2e-5)


@pytest.mark.parametrize("factor", [0.1, 7])
def test_only_the_ratio_of_the_display_counts_also_where_a_range_fits_it(factor):
    L = np.geomspace(3, 60, 64 * 64, dtype=np.float32).reshape(64, 64)
    shown = ward.tonemap(L)
    assert np.allclose(shown, ((L / L.max() * 100) - 1) / 99, atol=0.02)
    assert np.allclose(ward.tonemap(L, black=factor, white=100 * factor), shown, atol=1e-5)


def test_only_the_ratio_of_the_display_counts():
    L = laws.scene()
    assert np.allclose(
        ward.tonemap(L, black=1, white=100), ward.tonemap(L, black=0.5, white=50), atol=1e-6
    )


@pytest.mark.parametrize(
    "knobs",
    [
        {"black": 0},
        {"black": 5, "white": 5},
        {"bins": 0},
        {"field": 0},
        {"tolerance": 0},
        {"tolerance": 1},
        {"white": np.nan},
    ],
)
def test_invalid_parameters_raise_an_error(knobs):
    with pytest.raises(ValueError, match="0 < black < white"):
        ward.tonemap(np.ones((3, 3)), **knobs)


@pytest.mark.parametrize("name", ["lobby", "venice"])
def test_real_maps_are_displayed_well_exposed(shared, name):
    Ld = ward.tonemap(luminance(rgbe.read(shared("hdri_cc0") / f"{name}.hdr")))
    assert 0.05 < np.median(Ld) < 0.4 and np.mean(Ld == 1) < 0.01


@pytest.mark.parametrize("knobs", [{}, {"bins": 1}, {"white": 1e5}, {"bins": 5000}])
def test_the_fast_table_equals_the_exponential_of_the_curve(knobs):
    L = laws.scene()
    b, lnLd = ward.curve(L, **knobs)
    white = knobs.get("white", 100)
    plain = (np.exp(np.interp(np.log(np.maximum(L, 1e-37)), b, lnLd)) - 1) / (white - 1)
    assert np.allclose(ward.tonemap(L, **knobs), np.clip(plain, 0, 1), atol=1e-5)


def test_the_foveal_image_is_the_mean_of_each_square_degree():
    L = laws.scene((45, 62))
    Lf = ward.foveal_image(L, field=31)  # of 2 x 2 pixels, and one row that is left over
    assert Lf.shape == (23, 31)
    assert np.allclose(Lf[:22], L[:44].reshape(22, 2, 31, 2).mean(axis=(1, 3)), rtol=1e-5)
    assert np.allclose(Lf[22], L[44].reshape(31, 2).mean(axis=1), rtol=1e-5)
