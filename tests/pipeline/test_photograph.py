"""The default image: settings from the map, compressed luminance, constant hue, and its warnings."""

import numpy as np
import pytest
from scipy.ndimage import uniform_filter

from hdrlab import scenes
from hdrlab.core import colour
from hdrlab.core.picture import gray, statistics
from hdrlab.pipeline import develop, develop_and_describe
from hdrlab.pipeline.photograph import (
    cell_weights,
    choose_settings,
    compress_light,
    filter_light,
    find_logarithm,
    interpolation_weights,
    measure_scene_ev,
    photograph,
)
from hdrlab.tonemap import durand

PLACES = {name: getattr(scenes, name) for name in ("chapel", "workshop", "street", "room")}
GRAY = np.geomspace(1, 1e4, 96 * 128, dtype=np.float32).reshape(96, 128)


@pytest.fixture(scope="module", params=PLACES)
def E(request):
    return PLACES[request.param]((160, 240))


def test_a_developed_scene_is_well_exposed_and_hardly_clipped(E):
    statistics_found = statistics(develop(E))
    assert 95 < statistics_found.mean < 140
    assert statistics_found.contrast > 35
    assert statistics_found.white < 0.02
    assert statistics_found.black < 0.02


def test_a_developed_scene_uses_the_range_from_black_to_white(E):
    low, high = np.quantile(gray(develop(E)), [0.005, 0.998])
    assert low < 40 and high > 225


def test_the_unit_of_the_map_does_not_matter(E):
    assert np.abs(develop(E).astype(int) - develop(1000 * E)).max() <= 1


def test_a_downscaled_map_is_developed_to_a_similar_image(E):
    small = E.reshape(80, 2, 120, 2, 3).mean(axis=(1, 3))
    half = develop(E).astype(float).reshape(80, 2, 120, 2, 3).mean(axis=(1, 3))
    assert np.median(np.abs(develop(small) - half)) < 4


def test_colors_beyond_the_display_keep_their_hue():
    """A sky that gets brighter: clipping its blue would turn it cyan, and the default does not."""
    sky = np.float32([0.25, 0.5, 1.0]) * np.geomspace(0.1, 10, 60 * 80, dtype=np.float32).reshape(
        60, 80, 1
    )
    away = {}
    for way in ("ratio", "hue"):
        C = colour.decode_srgb(develop(sky, "reinhard", way=way) / 255.0)[-20:]
        hue = (C[..., 1] - C[..., 0]) / (C[..., 2] - C[..., 0])  # 1/3 in the map
        away[way] = np.abs(hue - 1 / 3).max()
    assert away["hue"] < 0.03 < 0.1 < away["ratio"]


def test_ratio_and_hue_agree_for_colors_in_gamut():
    E = np.float32([[[3.0, 2.0, 1.0], [0.2, 0.2, 0.2]]])
    L = colour.luminance(E)
    assert np.array_equal(
        *(colour.render(E, L, [[0.2, 0.99]], way=way) for way in ("hue", "ratio"))
    )


def test_more_light_of_one_color_is_never_shown_darker():
    for shade in ([1.0, 0.3, 0.02], [0.02, 0.05, 1.0], [0.5, 1.0, 0.3]):
        E = np.float32(shade) * np.ones((1, 256, 1), np.float32)
        shown = colour.render(E, colour.luminance(E), np.linspace(0, 1, 256)[None], way="hue")
        assert np.all(np.diff(gray(shown)[0]) >= -0.8)  # rounding to levels aside


def test_compress_light_compresses_large_steps_and_keeps_detail():
    stripes = 0.05 * (np.arange(200) % 2)
    lL = (np.where(np.arange(200) < 100, 0, 4) + stripes + np.zeros((150, 1))).astype(np.float32)
    light = filter_light(lL)
    x = compress_light(lL, 0.5, light)[75]
    assert np.median(x[150:]) - np.median(x[:50]) == pytest.approx(2, abs=0.1)
    assert np.ptp(x[20:22]) == pytest.approx(0.05, rel=0.1)
    assert np.array_equal(compress_light(lL, 1.0, light), lL)


def test_interpolation_from_the_means_of_cells_restores_a_ramp():
    ramp = np.arange(17, dtype=np.float32)
    restored = interpolation_weights(17, 4) @ (cell_weights(17, 4) @ ramp)
    assert np.allclose(restored[6:-6], ramp[6:-6], atol=1e-4)


def test_filter_light_is_a_guided_filter_on_a_coarse_grid():
    lL = np.log10(PLACES["room"]((200, 300))).mean(axis=-1).astype(np.float32)
    width = 2 * 4 + 1

    def average_cells(image):
        return image.reshape(100, 2, 150, 2).mean(axis=(1, 3))

    mean = uniform_filter(average_cells(lL), width)
    variance = np.maximum(uniform_filter(average_cells(lL * lL), width) - mean * mean, 0)
    slope = variance / (variance + 0.35**2)
    light = filter_light(lL)
    for filtered, plain in (light.slope, slope), (light.offset, mean - slope * mean):
        averaged = average_cells(light.row_weights @ filtered)[1:-1, 1:-1]
        assert np.abs(averaged - uniform_filter(plain, width)[1:-1, 1:-1]).max() < 0.02


def test_a_mirrored_map_gets_the_mirrored_picture(E):
    picture = develop(E).astype(int)
    for axis in (0, 1):
        mirrored = np.flip(develop(np.flip(E, axis)), axis)
        assert np.abs(picture - mirrored).max() <= 2


def test_a_map_with_one_column_cut_off_gets_the_same_picture(E):
    difference = np.abs(develop(E).astype(int)[:, 1:] - develop(E[:, 1:]))
    assert (difference > 5).mean() < 0.001


@pytest.mark.parametrize("edge_width", [10, 40, 100, 200])
def test_levels_fall_by_at_most_a_few_values_next_to_an_edge_that_rises(edge_width):
    """Three decades over `edge_width` pixels on a slope of 0.3 decades."""
    x = np.arange(600)
    edge = np.clip((x - 300) / edge_width + 0.5, 0, 1)
    E = np.tile(10 ** (0.3 * x / 600 + 3 * edge), (400, 1)).astype(np.float32)
    row = develop(E)[200].astype(int)
    assert np.max(np.maximum.accumulate(row) - row) <= 6


def test_the_settings_are_reported_and_can_be_overridden():
    made = develop_and_describe(GRAY)
    assert made.settings.startswith("photograph, share 0.") and "key 0.24" in made.settings
    assert "saturation" in made.settings and np.array_equal(made.picture, develop(GRAY))
    brighter = develop_and_describe(GRAY, key=0.5)
    assert "key 0.5," in brighter.settings and brighter.picture.mean() > made.picture.mean() + 10
    assert (
        develop_and_describe(GRAY, "durand", contrast=20).settings
        == "durand, contrast 20, saturation 1"
    )
    assert "<lambda>" in develop_and_describe(GRAY, lambda L: np.zeros_like(L)).settings


def test_a_bright_sky_that_covers_half_of_the_image_keeps_its_clouds():
    y, x = np.indices((120, 180))
    clouds = 1 + 0.3 * np.sin(x / 9) * np.cos(y / 7)
    light = np.where(y < 66, 12 * clouds, 0.6 * clouds)
    E = np.float32(light[..., None] * [0.95, 1.0, 1.1])
    picture = develop(E)
    assert np.mean(picture.max(axis=-1) >= 252) < 0.1
    assert gray(picture)[:60].std() > 13


def test_bright_saturated_light_keeps_its_color():
    x = np.linspace(-1, 1, 180)
    lamp = 0.02 + np.exp(-8 * (x**2 + np.linspace(-1, 1, 120)[:, None] ** 2))
    E = np.float32(lamp[..., None] * [1.0, 0.3, 0.05])
    picture = develop(E).astype(float)
    assert np.mean(picture.max(axis=-1) >= 252) < 0.1
    bright = lamp > 0.5
    assert np.median(picture[bright][:, 2] / picture[bright][:, 0]) < 0.6


def test_a_scene_of_narrow_range_is_not_compressed():
    even = np.float32([1, 1.1]) * np.ones((50, 40, 1), np.float32)
    assert choose_settings(even.reshape(50, 80))["share"] == 1


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    "E", [np.zeros((4, 5, 3)), np.ones((1, 1)), np.eye(3) * 1e30, np.full((2, 300, 3), 1e-30)]
)
def test_any_radiance_can_be_developed_and_black_stays_black(E):
    picture = develop(E)
    assert picture.shape == E.shape and np.all(picture[np.asarray(E) == 0] <= 13)


@pytest.mark.parametrize(
    "wrong", [{"share": 0}, {"key": 0}, {"white": -1}, {"black": 1}, {"key": "auto"}]
)
def test_settings_out_of_range_raise_an_error(wrong):
    with pytest.raises(ValueError, match="share"):
        develop(GRAY, **wrong)
    with pytest.raises(ValueError, match="negative"):
        photograph(-GRAY, share=1, key=0.2, white=2, black=0)


def test_find_logarithm_equals_the_logarithm_of_the_lesson():
    L = np.random.default_rng(5).lognormal(0, 4, (40, 60)).astype(np.float32)
    L[:3] = 0
    assert np.allclose(find_logarithm(L)(L), durand.logarithm(L), rtol=1e-6)


def with_scene_ev(E, ev):
    """Return the luminance of a unit with which the map E is a scene of this exposure value."""
    return 2 ** (ev - measure_scene_ev(E, 1.0))


def test_a_night_is_darker_than_the_same_map_by_day(E):
    day = statistics(develop(E, luminance_of_unit=with_scene_ev(E, 12))).mean
    evening = statistics(develop(E, luminance_of_unit=with_scene_ev(E, 4))).mean
    night = statistics(develop(E, luminance_of_unit=with_scene_ev(E, 0))).mean
    assert night < 95
    assert night < evening < day


def test_a_bright_scene_gets_the_same_picture_whether_its_luminance_is_known_or_not(E):
    known = develop(E, luminance_of_unit=with_scene_ev(E, 10))
    assert np.array_equal(known, develop(E))


def test_a_scene_of_unknown_luminance_is_kept_dark_if_it_has_an_upper_bound(E):
    bound = with_scene_ev(E, 0)
    known = develop_and_describe(E, luminance_of_unit=bound)
    bounded = develop_and_describe(E, max_luminance_of_unit=bound)
    assert np.array_equal(known.picture, bounded.picture)
    assert "at most" in bounded.settings and "at most" not in known.settings
    bright = develop(E, max_luminance_of_unit=with_scene_ev(E, 10))
    assert np.array_equal(bright, develop(E))


def test_a_night_does_not_depend_on_the_unit_of_its_map(E):
    night = develop(E, luminance_of_unit=0.01)
    scaled = develop(8 * E, luminance_of_unit=0.01 / 8)
    assert np.abs(night.astype(int) - scaled).max() <= 1


def test_an_explicit_key_is_used_also_at_night():
    assert "key 0.3" in develop_and_describe(GRAY, luminance_of_unit=1e-6, key=0.3).settings


def test_a_black_map_has_an_exposure_value_below_every_night():
    assert measure_scene_ev(np.zeros((4, 4), np.float32), 1.0) == -np.inf
    assert not develop(np.zeros((4, 4), np.float32), luminance_of_unit=1.0).any()


def test_a_night_stays_dark_where_a_bright_sky_covers_half_of_the_image():
    rng = np.random.default_rng(3)
    E = rng.lognormal(0, 0.3, (90, 120)).astype(np.float32)
    E[:45] *= 20
    night = develop(E, luminance_of_unit=with_scene_ev(E, 0))
    assert statistics(night).mean < 85
    sky = night[:45]
    assert np.mean(sky >= 250) < 0.05 and sky.mean() > night[45:].mean() + 30
