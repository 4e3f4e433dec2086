"""The laws that checks assert about an operator: their scenes, and which operators pass."""

import warnings

import numpy as np
import pytest

from hdrlab.course.checks import laws

# of each scene: shape, first, second and last value, sum
SCENES = {
    "a scene": ((96, 128), 1.22343373, 1.14682027, 8.00329399, 3046246.37),
    "a scene with zeros": ((96, 128), 0, 1.14682027, 8.00329399, 2128093.28),
    "all zeros": ((16, 20), 0, 0, 0, 0),
    "one lamp in the dark": ((16, 20), 0, 0, 0, 3),
    "1e-12": ((16, 20), 1e-12, 1e-12, 1e-12, 3.2e-10),
    "1e12": ((16, 20), 1e12, 1e12, 1e12, 3.2e14),
    "1e-12 next to 1e12": ((16, 20), 1e-12, 1e-12, 1e12, 1.6e14),
    "the range of float32": ((16, 20), 1e-45, 1e-45 * 3e83 ** (1 / 319), 3e38, 6.62858063e38),
    "one hot pixel": ((96, 128), 1.22343373, 1.14682027, 8.00329399, 1.00000303e12),
    "a constant": ((33, 17), 3.7, 3.7, 3.7, 2075.7),
    "1 x 1": ((1, 1), 5, 5, 5, 5),
    "2 x 3": ((2, 3), 0, 1, 5e5, 500406),
    "one row": ((1, 200), 1.22343373, 1.14149368, 248.178898, 18148.1865),
    "integers": ((16, 20), 0, 1, 319, 51040),
    "float64": ((96, 128), 1.22343373, 1.14682027, 8.00329399, 3046246.37),
}


def test_this_file_has_a_row_for_each_scene_of_the_laws():
    assert SCENES.keys() == laws.RADIANCES.keys()


@pytest.mark.parametrize("name", SCENES)
def test_each_scene_of_the_laws_is_the_same_in_every_year(name):
    shape, *values, whole = SCENES[name]
    L = laws.RADIANCES[name]
    assert L.shape == shape
    assert np.allclose(
        [L.flat[0], L.flat[min(1, L.size - 1)], L.flat[-1]], values, rtol=1e-6, atol=0
    )
    assert np.isclose(L.sum(dtype=np.float64), whole, rtol=1e-6, atol=0)


def test_halves_and_hot_pixels_have_fixed_positions():
    assert laws.RADIANCES["1e-12 next to 1e12"][:, 9:11].tolist() == [[1e-12, 1e12]] * 16
    assert np.argwhere(laws.RADIANCES["one lamp in the dark"]).tolist() == [[8, 6]]
    assert np.argwhere(laws.RADIANCES["one hot pixel"] > 1e11).tolist() == [[48, 42]]
    assert laws.RADIANCES["2 x 3"].tolist() == [[0, 1, 2], [3, 400, 5e5]]
    assert not laws.RADIANCES["a scene with zeros"][:, ::3].any()
    L = np.zeros((5, 7))
    assert np.argwhere(laws.hot_pixel(L)).tolist() == [[2, 2]] and laws.hot_pixel(L).max() == 1e12
    assert not L.any(), "what was given is changed"


def test_the_scene_has_a_soft_light_a_window_and_a_dark_floor_with_texture_of_thirty_percent():
    L = np.log(laws.scene((7, 10), seed=3).astype(np.float64))
    texture = np.random.default_rng(3).standard_normal((7, 10))
    light = (L - 0.3 * texture) / 1.5
    soft = [
        4 * np.exp(-8 * 0.45),
        4,
        4 * np.exp(-8 * 0.04),
        4 * np.exp(-8 * 0.09),
        4 * np.exp(-8 * 0.04),
    ]
    places = [(0, 0), (3, 6), (3, 8), (3, 9), (5, 6)]
    assert np.allclose([light[at] for at in places], np.add(soft, [0, 0, 0, 3, 0]), atol=1e-6)
    assert np.isclose(light[6, 6], 4 * np.exp(-8 * 0.09) - 2, atol=1e-6)


# What the laws ask


def simple(L):
    return (L / (L + np.float32(1))).astype(np.float32)


def shown(L, *, sign=1, stripes=0.0, boost=0.0):
    """An image with the mean light of each region, in stripes that cancel within a region."""
    log = (
        np.log(np.maximum(L, 1e-9))
        .reshape(6, 16, 8, 16)
        .mean(axis=(1, 3))
        .repeat(16, 0)
        .repeat(16, 1)
    )
    ranks = (log - log.min()) / np.ptp(log)
    even = np.where(np.arange(96) % 2, -1, 1)[:, None]
    return 0.5 + sign * 0.06 * (ranks - 0.5) + stripes * even + np.where(even > 0, boost * ranks, 0)


def test_a_picture_is_refused_for_the_warning_that_it_gave():
    def warns(L):
        warnings.warn("of a kind", UserWarning, stacklevel=1)
        return simple(L)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with pytest.raises(UserWarning, match="kind"):
            laws.stays_in_range(warns)


def test_an_operator_that_reads_values_alone_takes_any_memory_layout_and_one_that_reads_bytes_does_not():
    laws.takes_any_memory_layout(simple)
    for odd in (
        lambda L: simple(L) * L.flags.c_contiguous,
        lambda L: simple(L) * (L.strides[1] <= 4),
        lambda L: simple(L) * (L.dtype.byteorder != ">"),
    ):
        with pytest.raises(AssertionError):
            laws.takes_any_memory_layout(odd)


@pytest.mark.parametrize("law", [laws.shows_the_scene, laws.keeps_the_light_the_right_way_up])
def test_stripes_that_cancel_within_a_region_change_no_verdict_of_a_law_about_regions(law):
    for stripes in (0, 0.3):
        law(lambda L, stripes=stripes: shown(L, stripes=stripes))
        mixed = (
            np.random.default_rng(0).permutation(48).reshape(6, 8).repeat(16, 0).repeat(16, 1) / 480
        )
        with pytest.raises(AssertionError):
            law(
                lambda L, mixed=mixed, stripes=stripes: shown(0 * L + 1e-3 + mixed, stripes=stripes)
            )


def test_light_that_is_upside_down_shows_the_scene_and_is_not_the_right_way_up():
    laws.shows_the_scene(lambda L: shown(L, sign=-1))
    with pytest.raises(AssertionError):
        laws.keeps_the_light_the_right_way_up(lambda L: shown(L, sign=-1))


def test_clipped_pixels_show_no_detail():
    with pytest.raises(AssertionError, match="equally bright"):
        laws.shows_the_scene(lambda L: np.where(shown(L, stripes=1) > 1, 4 * shown(L), 0.5))
    laws.shows_the_scene(lambda L: np.where(shown(L, stripes=1) > 1, 3 * (shown(L) - 0.4), 0.5))


FACTORS = [(2.0**-20, 1e-5), (2.0**20, 1e-5), (3.7e-6, 2e-4), (5.1e7, 2e-4)]


@pytest.mark.parametrize(("factor", "allowed"), FACTORS)
@pytest.mark.parametrize("name", ["a scene", "a scene with zeros"])
def test_an_exposure_may_move_a_picture_by_as_much_as_its_factor_allows(factor, allowed, name):
    L = laws.RADIANCES[name] * np.float32(factor)
    maxima = []

    def moved(error):
        def tonemap(radiance):
            maxima.append(radiance.max())
            return np.full(radiance.shape, error if np.array_equal(radiance, L) else 0.0)

        return tonemap

    laws.exposure(moved(0.99 * allowed))
    with pytest.raises(AssertionError):
        laws.exposure(moved(1.01 * allowed))
    whole = laws.scene().max()
    assert maxima[:10] == [whole, whole, *(whole * np.float32(step) for step, _ in FACTORS * 2)]


# A random response, and the distance of a curve from it


class Drawn:
    """A fake random generator that draws a gamma of 2, a shoulder of 1/2, no toe, and a quarter of
    film.
    """

    def uniform(self, low, high):
        self.bounds = low, high
        return 2.0, 0.5, 1.0, 0.25


def test_a_drawn_response_mixes_a_gamma_and_a_film_curve_in_the_drawn_shares():
    rng = Drawn()
    f, inverse = laws.drawn_response(rng)
    assert rng.bounds == ((1.4, 0.5, 1.05, 0.2), (2.4, 1.2, 1.4, 0.42))
    X = np.array([0, 0.25, 0.5, 1])
    M = np.array([0, 0.75 * 0.5 + 0.25 * 0.5, 0.75 * 0.5**0.5 + 0.25 * 0.75, 1])
    assert np.allclose(f(X), M, rtol=1e-12) and np.allclose(inverse(M), X, atol=1e-12)


def test_the_same_seed_draws_the_same_response_in_every_year():
    f, _ = laws.drawn_response(np.random.default_rng(0))
    assert np.allclose(
        f(np.array([0.01, 0.1, 0.5])), [0.08670684, 0.29540986, 0.70758302], rtol=1e-6
    )


def test_a_constant_curve_errs_by_the_spread_of_the_true_curve():
    levels = np.log(np.maximum(np.arange(256.0), 1))
    assert np.isclose(
        laws.curve_error(np.zeros(256), levels), np.sqrt((241**2 - 1) / 12) / 250, rtol=1e-12
    )
    assert laws.curve_error(levels + 5, levels) < 1e-15


def test_a_curve_is_evaluated_at_equally_many_levels_for_any_bit_depth():
    levels = np.log(np.maximum(np.arange(1024.0), 1))
    at = np.array([k * 1023 // 255 for k in range(10, 251)])
    expected = np.std(at) / (250 * 1023 // 255)
    assert np.isclose(laws.curve_error(np.zeros(1024), levels), expected, rtol=1e-12)


def test_a_curve_that_is_wrong_at_one_level_errs_by_its_share_of_the_fit():
    truth = np.zeros(256)
    g = truth.copy()
    g[100] = np.log(3)
    unit = (240 + 3) / (240 + 9)
    expected = np.sqrt((240 * (unit - 1) ** 2 + (3 * unit - 1) ** 2) / 241)
    assert np.isclose(laws.curve_error(g, truth), expected, rtol=1e-12)
