"""Merging a radiance map: the weighted mean of the photos, and pixels that no photo measures."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra.numpy import arrays

from hdrlab.capture import camera, responses
from hdrlab.core import threads, weights
from hdrlab.errors import InputError
from hdrlab.fast import merge as quick
from hdrlab.radiance import merge as lesson
from hdrlab.radiance.merge import METHODS, Quality
from hdrlab.response import linear

LINEAR = linear.curve()
FILM = responses.true_g("film")
# the functions that are tested: the fast ones, or those of the lesson (see `either`)
merge = quick.merge
merge_with_quality = quick.merge_with_quality
CURVES = sorted(responses.RESPONSES)


@pytest.fixture(scope="module", params=[lesson, quick], ids=["lesson", "fast"], autouse=True)
def either(request):
    """Run each test on the functions of the lesson, and on the fast ones."""
    names = {name: getattr(request.param, name) for name in ("merge", "merge_with_quality")}
    globals().update(names)
    return request.param


TOP = 250  # the first clipped of 256 levels, at the default cut of 0.98


def row(*frames, dtype=np.uint8):
    """Return frames of one row of gray pixels, (P, 1, W)."""
    return np.array(frames, dtype)[:, None]


# The four estimates


@pytest.mark.parametrize("method", METHODS)
def test_one_frame_gives_its_exposure_over_its_time(method):
    images = np.arange(1, TOP, dtype=np.uint8)[None, None]
    E = merge_with_quality(images, [0.5], FILM, method=method).E
    assert np.allclose(E, np.exp(FILM[1:TOP]) / 0.5, rtol=1e-5)


def test_each_method_follows_its_formula():
    z = np.array([60, 200])
    t = np.array([0.25, 1.0])
    w = weights.hat()
    wz = w[z]
    X = np.exp(FILM[z])
    expected = {
        "log": np.exp(np.sum(wz * (FILM[z] - np.log(t))) / wz.sum()),
        "likelihood": np.sum(wz * X * t) / np.sum(wz * t**2),
        "mean": np.sum(wz * X / t) / wz.sum(),
        "shot": np.sum(wz * X) / np.sum(wz * t),
    }
    assert set(expected) == set(METHODS)
    for method, E in expected.items():
        assert np.isclose(
            merge_with_quality(row([60], [200]), t, FILM, w, method=method).E[0, 0], E, rtol=1e-6
        )


@pytest.mark.parametrize("name", CURVES)
def test_all_methods_agree_for_photos_without_noise(name, decades):
    E = decades((40, 60))
    taken = camera.shoot(
        E, camera.times_around(E, 7, stops=2), camera.Camera(response=name, bits=16)
    )
    g = responses.true_g(name, 65536)
    maps = [
        merge_with_quality(taken.images, taken.times, g, weights.gaussian(65536), method=m)
        for m in METHODS
    ]
    measured = maps[0].quality == Quality.MEASURED
    for merged in maps:
        assert np.array_equal(merged.quality, maps[0].quality)
        assert np.allclose(merged.E[measured] / maps[0].E[measured], 1, atol=0.002)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", CURVES)
def test_radiance_is_accurate_within_one_percent_where_well_exposed(name, method, seven_frames):
    E, taken = seven_frames(name)
    merged = merge_with_quality(
        taken.images, taken.times, responses.true_g(name), weights.gaussian(), method=method
    )
    well = ((taken.images > 30) & (taken.images < 225)).any(axis=0)
    ratio = merged.E[well] / E[well]
    assert well.mean() > 0.8 and np.median(np.abs(ratio / np.median(ratio) - 1)) < 0.01


# Invariances


@pytest.mark.parametrize("times", [[1.0, 2, 8], [1.0, 1, 2], [3.0, 3, 3]])
@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("method", METHODS)
def test_any_order_of_frames_gives_the_same_map_bit_for_bit(method, bits, times):
    dtype = np.uint8 if bits == 8 else np.uint16
    rng = np.random.default_rng(3)
    images = rng.integers(0, 2**bits, (3, 6, 7, 3), dtype)
    valid = rng.random((3, 6, 7)) > 0.2
    times = np.array(times)
    first = merge_with_quality(images, times, FILM, method=method, valid=valid)
    for order in map(list, permutations(range(3))):
        other = merge_with_quality(
            images[order], times[order], FILM, method=method, valid=valid[order]
        )
        assert np.array_equal(other.E, first.E) and np.array_equal(other.quality, first.quality)


@pytest.mark.parametrize("method", METHODS)
def test_16_bit_photos_give_the_same_map_as_8_bit_ones(method):
    images = np.random.default_rng(4).integers(0, 256, (3, 20, 30, 3), np.uint8)
    eight = merge_with_quality(images, [1, 2, 8], FILM, method=method)
    sixteen = merge_with_quality(images.astype(np.uint16) * 257, [1, 2, 8], FILM, method=method)
    measured = eight.quality == Quality.MEASURED
    assert np.array_equal(sixteen.quality, eight.quality)
    assert np.allclose(sixteen.E[measured], eight.E[measured], rtol=2e-6)
    assert np.allclose(sixteen.E, eight.E, rtol=0.02)  # a clipped level begins half a level earlier


def test_a_gray_stack_gives_the_same_as_three_equal_channels():
    images = np.random.default_rng(5).integers(0, 256, (3, 20, 30), np.uint8)
    gray = merge_with_quality(images, [1, 2, 8], FILM)
    rgb = merge_with_quality(
        np.stack([images] * 3, axis=-1), [1, 2, 8], np.stack([FILM] * 3, axis=-1)
    )
    assert gray.E.shape == (20, 30) and rgb.E.shape == (20, 30, 3)
    assert np.array_equal(gray.quality, rgb.quality)
    assert all(np.array_equal(rgb.E[..., c], gray.E) for c in range(3))


@pytest.mark.parametrize("method", METHODS)
def test_doubled_times_halve_the_map(method):
    images = np.random.default_rng(6).integers(0, 256, (4, 20, 30, 3), np.uint8)
    once = merge_with_quality(images, [1, 2, 8, 16], FILM, method=method)
    twice = merge_with_quality(images, [2, 4, 16, 32], FILM, method=method)
    assert np.array_equal(once.quality, twice.quality)
    assert np.allclose(once.E, 2 * twice.E, rtol=2e-6)


def test_the_scale_of_the_weights_does_not_matter():
    images = np.random.default_rng(7).integers(0, 256, (3, 20, 30), np.uint8)
    maps = [merge(images, [1, 2, 8], FILM, k * weights.hat()) for k in (1, 1e-3, 255)]
    assert np.allclose(maps[0], maps[1], rtol=1e-5) and np.allclose(maps[0], maps[2], rtol=1e-5)


def test_the_number_of_threads_does_not_change_the_map(monkeypatch):
    images = np.random.default_rng(8).integers(0, 256, (3, 70, 30, 3), np.uint8)
    monkeypatch.setattr(threads, "THREADS", 1)
    with_one_thread = quick.merge_with_quality(images, [1, 2, 8], FILM)
    monkeypatch.setattr(threads, "THREADS", 3)
    with_three_threads = quick.merge_with_quality(images, [1, 2, 8], FILM)
    assert np.array_equal(with_one_thread.E, with_three_threads.E)
    assert np.array_equal(with_one_thread.quality, with_three_threads.quality)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_merge_does_not_change_its_arguments_in_any_memory_layout(dtype):
    images = np.random.default_rng(9).integers(0, np.iinfo(dtype).max, (3, 40, 30, 3), dtype)
    g = responses.true_g("film", np.iinfo(dtype).max + 1)
    fortran_images = np.asfortranarray(images)
    plain = merge(images, [4, 2, 1], g)
    fortran_images.setflags(write=False)
    assert np.array_equal(merge(fortran_images, [4, 2, 1], g), plain)
    assert np.array_equal(fortran_images, images)
    wide = np.repeat(images, 2, axis=2)[:, :, ::2]
    assert np.array_equal(merge(wide, [4, 2, 1], g), plain)
    assert np.array_equal(merge(list(images), [4, 2, 1], g), plain)


# What no frame measures


@pytest.mark.parametrize("method", METHODS)
def test_a_pixel_clipped_in_every_frame_gets_the_bound_of_the_shortest_and_a_flag(method):
    merged = merge_with_quality(row([255, 100], [255, 200]), [0.25, 0.5], FILM, method=method)
    assert np.isclose(merged.E[0, 0], np.exp(FILM[TOP]) / 0.25, rtol=1e-6)
    assert merged.quality.tolist() == [[Quality.CLIPPED, Quality.MEASURED]]


@pytest.mark.parametrize(("level", "bound"), [(255, TOP), (0, 1)])
def test_each_channel_has_its_own_bound(level, bound):
    g = np.stack([FILM, LINEAR, FILM + 1], axis=-1)
    E = merge(np.full((1, 2, 2, 3), level, np.uint8), [0.5], g)
    assert np.allclose(E, np.exp(g[bound]) / 0.5, rtol=1e-6)


@pytest.mark.parametrize("method", METHODS)
def test_a_pixel_dark_in_every_frame_gets_the_bound_of_the_longest_and_a_flag(method):
    merged = merge_with_quality(row([0, 10], [0, 20]), [0.25, 0.5], FILM, method=method)
    assert np.isclose(merged.E[0, 0], np.exp(FILM[1]) / 0.5, rtol=1e-6)
    assert merged.quality.tolist() == [[Quality.DARK, Quality.MEASURED]]


def test_a_pixel_dark_in_one_frame_and_clipped_in_the_next_gets_the_mean_of_its_bounds():
    merged = merge_with_quality(row([0, 10], [255, 20]), [0.25, 1024], FILM)
    low = np.exp(FILM[TOP]) / 1024
    high = np.exp(FILM[1]) / 0.25
    assert low < high and np.isclose(merged.E[0, 0], np.sqrt(low * high), rtol=1e-6)
    assert merged.quality[0, 0] == Quality.DARK | Quality.CLIPPED


STACKS = arrays(np.uint8, st.tuples(*[st.integers(1, 5)] * 3, st.just(3)))


@given(STACKS, st.sampled_from(sorted(METHODS)), st.data())
def test_measured_radiance_lies_between_the_bounds_of_dark_and_clipped_pixels(images, method, data):
    """A measured pixel lies between the value of a dark pixel and that of a clipped one."""
    times = np.array(
        data.draw(st.lists(st.floats(1e-3, 30), min_size=len(images), max_size=len(images)))
    )
    merged = merge_with_quality(images, times, FILM, method=method, repair=False)
    low = np.exp(FILM[1]) / times.max()
    high = np.exp(FILM[TOP]) / times.min()
    assert merged.E.dtype == np.float32 and np.all(np.isfinite(merged.E))
    assert np.all(merged.E >= low * (1 - 1e-5)) and np.all(merged.E <= high * (1 + 1e-5))
    clipped = (images >= TOP).all(axis=0)
    assert np.allclose(merged.E[clipped], high)
    assert np.all(merged.quality[clipped.any(axis=-1)] & Quality.CLIPPED)


@given(
    arrays(
        np.uint16,
        st.tuples(*[st.integers(1, 4)] * 3),
        elements=st.sampled_from([0, 1, 257, 40000, 64000, 65535]),
    ),
    st.sampled_from(sorted(METHODS)),
    st.data(),
)
def test_any_16_bit_stack_with_any_mask_gives_a_finite_map_that_is_not_negative(
    images, method, data
):
    valid = data.draw(arrays(bool, images.shape))
    times = 2.0 ** np.arange(len(images))
    merged = merge_with_quality(
        images, times, responses.true_g("gamma", 65536), method=method, valid=valid
    )
    assert np.all(np.isfinite(merged.E)) and np.all(merged.E >= 0)
    assert np.array_equal(
        (merged.quality & Quality.UNSEEN) > 0,
        ~valid.any(axis=0) & (merged.quality != Quality.STUCK),
    )
    assert np.all((merged.E > 0) | (merged.quality != Quality.MEASURED))


@pytest.mark.parametrize("level", [0, 255])
def test_black_or_white_stacks_give_finite_maps_without_measured_pixels(level):
    merged = merge_with_quality(np.full((3, 4, 5, 3), level, np.uint8), [1, 2, 4], FILM)
    assert np.all(np.isfinite(merged.E)) and np.ptp(merged.E) == 0
    assert np.all(merged.quality == (Quality.CLIPPED if level else Quality.DARK))


def test_a_clipped_sun_is_not_darker_than_its_sky():
    y, x = np.mgrid[-40:40, -60:60]
    E = (2 + 60 * np.exp(-np.hypot(y, x) / 12) + 1e5 * (np.hypot(y, x) < 6)).astype(np.float32)
    taken = camera.shoot(
        E, [1 / 256, 1 / 64, 1 / 16, 1 / 4], camera.Camera(full_well=20_000, read_noise=5), rng=1
    )
    merged = merge_with_quality(taken.images, taken.times, FILM)
    sun = np.hypot(y, x) < 5
    assert np.all(merged.quality[sun] == Quality.CLIPPED)
    assert merged.E[sun].min() >= merged.E[~sun].max()


# Clipped in one channel


def test_a_frame_with_one_clipped_channel_is_left_out_for_all_three():
    images = np.array([[[[100, 60, 40]]], [[[255, 200, 160]]]], np.uint8)
    short_alone = merge(images[:1], [1], LINEAR)
    assert np.array_equal(merge(images, [1, 3.5], LINEAR), short_alone)
    images[1, 0, 0, 0] = TOP - 1  # a level that is not clipped
    assert not np.allclose(merge(images, [1, 3.5], LINEAR), short_alone, rtol=1e-3)


def test_a_camera_that_clips_before_its_color_matrix_gives_lamps_no_tint():
    matrix = np.array([[1.9, -0.7, -0.2], [-0.3, 1.6, -0.3], [0.0, -0.6, 1.6]])
    lamp = np.geomspace(0.05, 8, 400)[:, None] * np.array([1.0, 0.7, 0.5])
    # of the camera's filters
    exposures = np.clip(np.array([0.25, 1, 4])[:, None, None] * lamp, 0, 1)
    images = np.round(255 * np.clip(exposures @ matrix.T, 0, 1)).astype(np.uint8)[:, :, None]
    g = np.log(np.maximum(np.arange(256), 0.5) / 255)
    merged = merge_with_quality(images, [0.25, 1, 4], g, method="shot", repair=False)
    truth = lamp @ matrix.T
    is_known = (merged.quality[:, 0] == 0) & (truth > 0.05).all(axis=-1)
    assert is_known.sum() > 100
    tint = np.log2(merged.E[:, 0][is_known] / truth[is_known])
    assert np.abs(tint - tint.mean(axis=-1, keepdims=True)).max() < 0.08


def test_where_every_frame_clips_a_channel_the_others_keep_their_measurement():
    images = np.array([[[[255, 100, 0]]], [[[255, 200, 1]]]], np.uint8)
    merged = merge_with_quality(images, [1, 2], LINEAR)
    assert np.allclose(merged.E[0, 0], [LINEAR_AT_TOP, 100 / 128, 1 / 128 / 2], rtol=1e-5)
    assert merged.quality[0, 0] == Quality.CLIPPED


LINEAR_AT_TOP = TOP / 128


def test_highlights_keep_the_colour_of_their_light():
    E = (np.geomspace(0.5, 50, 400)[None, :, None] * np.array([1.0, 0.7, 0.5])).astype(np.float32)
    taken = camera.shoot(
        np.repeat(E, 9, axis=0), 4.0 ** np.arange(-4, 1), camera.Camera(full_well=50_000), rng=2
    )
    merged = merge_with_quality(taken.images, taken.times, FILM)
    tint = np.median(merged.E, axis=0)[np.median(merged.quality, axis=0) == Quality.MEASURED]
    assert np.allclose(tint[:, 1:] / tint[:, :1], [0.7, 0.5], rtol=0.06)


# Stuck pixels


def flat_scene(shape=(12, 14, 3)):
    """Return three photographs of soft light, two stops apart, without noise."""
    light = np.linspace(0.3, 0.6, int(np.prod(shape[:2])), dtype=np.float32).reshape(shape[:2])
    return camera.shoot(np.stack([light] * 3, axis=-1), [1 / 16, 1 / 4, 1])


@pytest.mark.parametrize(
    ("level", "where"), [(255, (5, 6)), (200, (5, 6)), (255, (0, 0)), (255, (11, 7)), (0, (4, 13))]
)
def test_a_stuck_pixel_is_replaced_by_the_median_of_its_neighbors_and_flagged(level, where):
    taken = flat_scene()
    y, x = where
    images = taken.images.copy()
    images[:, y, x, 1] = level  # hot or dead in every frame
    clean = merge_with_quality(taken.images, taken.times, FILM)
    merged = merge_with_quality(images, taken.times, FILM)
    assert merged.quality[y, x] == Quality.STUCK and np.count_nonzero(merged.quality) == 1
    assert np.allclose(merged.E[y, x], clean.E[y, x], rtol=0.1)
    others = np.ones(merged.quality.shape, bool)
    others[y, x] = False
    assert np.array_equal(merged.E[others], clean.E[others])
    left = merge_with_quality(images, taken.times, FILM, repair=False)
    assert left.quality[y, x] != Quality.STUCK
    assert not np.allclose(left.E[y, x, 1], clean.E[y, x, 1], rtol=0.1)


def test_the_hot_pixels_of_a_camera_do_not_reach_the_map():
    light = np.linspace(0.2, 0.8, 60 * 80, dtype=np.float32).reshape(60, 80)
    taken = camera.shoot(
        light, 4.0 ** np.arange(-3, 1), camera.Camera(hot=0.002, full_well=50_000), rng=3
    )
    merged = merge_with_quality(taken.images, taken.times, FILM)
    hot = taken.images[0] == 255
    assert 3 < hot.sum() < 30 and np.array_equal(merged.quality == Quality.STUCK, hot)
    ratio = merged.E / light
    assert np.all(np.abs(ratio / np.median(ratio) - 1) < 0.1)


def test_a_measured_highlight_of_one_pixel_is_kept():
    E = np.full((9, 9), 0.3, np.float32)
    E[4, 4] = 12
    taken = camera.shoot(E, [1 / 16, 1 / 4, 1])
    merged = merge_with_quality(taken.images, taken.times, FILM)
    assert not merged.quality.any() and np.isclose(merged.E[4, 4] / merged.E[0, 0], 40, rtol=0.03)


def test_the_neighbors_of_a_clipped_highlight_are_not_changed():
    E = np.full((9, 9), 0.3, np.float32)
    dark = merge(camera.shoot(E, [1 / 16, 1 / 4, 1]).images, [1 / 16, 1 / 4, 1], FILM)
    E[3:5, 4:6] = 1000
    taken = camera.shoot(E, [1 / 16, 1 / 4, 1])
    merged = merge_with_quality(taken.images, taken.times, FILM)
    assert np.all(merged.quality[E == 1000] == Quality.CLIPPED)
    assert np.array_equal(merged.E[E < 1], dark[E < 1])


def test_without_two_exposures_nothing_counts_as_stuck():
    E = np.full((9, 9), 0.1, np.float32)
    E[4, 4] = 0.8
    for times in ([1.0], [1.0, 1.0], [1.0, 1.1]):
        merged = merge_with_quality(camera.shoot(E, times).images, times, FILM)
        assert not merged.quality.any()
        assert np.isclose(merged.E[4, 4] / merged.E[0, 0], 8, rtol=0.03)


# Masks and weights


def test_masked_pixels_are_not_merged():
    images = np.random.default_rng(10).integers(1, TOP, (3, 20, 30), np.uint8)
    valid = np.ones(images.shape, bool)
    valid[0, :, :10] = False
    valid[2, :, 20:] = False
    merged = merge_with_quality(images, [1, 2, 4], FILM, valid=valid, repair=False).E
    assert np.array_equal(
        merged[:, :10], merge_with_quality(images[1:, :, :10], [2, 4], FILM, repair=False).E
    )
    assert np.array_equal(
        merged[:, 20:], merge_with_quality(images[:2, :, 20:], [1, 2], FILM, repair=False).E
    )
    assert np.array_equal(
        merged[:, 10:20], merge_with_quality(images[:, :, 10:20], [1, 2, 4], FILM, repair=False).E
    )


def test_a_pixel_masked_in_every_frame_is_0_and_flagged():
    images = np.full((2, 3, 4, 3), 100, np.uint8)
    valid = np.ones((2, 3, 4), bool)
    valid[:, 1, 2] = False
    merged = merge_with_quality(images, [1, 2], FILM, valid=valid)
    assert np.all(merged.E[1, 2] == 0)
    assert merged.quality[1, 2] == Quality.UNSEEN
    assert np.count_nonzero(merged.quality) == 1


def test_bounds_are_computed_from_unmasked_frames():
    valid = np.array([[[False, True]], [[True, True]]])
    merged = merge_with_quality(row([255, 255], [255, 255]), [1, 4], FILM, valid=valid)
    assert np.allclose(merged.E, np.exp(FILM[TOP]) * np.array([[1 / 4, 1]]))


def test_a_masked_pixel_is_not_mistaken_for_a_stuck_one():
    taken = flat_scene()
    images = taken.images.copy()
    valid = np.ones(taken.images.shape[:3], bool)
    images[[0, 2], 5, 6] = 255
    valid[[0, 2], 5, 6] = False
    merged = merge_with_quality(images, taken.times, FILM, valid=valid)
    assert not merged.quality.any()
    assert np.array_equal(merged.E[5, 6], merge(taken.images[1:2], taken.times[1:2], FILM)[5, 6])


def test_pixels_with_weight_0_in_all_frames_are_still_measured():
    w = weights.cut(weights.flat(), above=0.8, below=0.2)
    merged = merge_with_quality(row([20, 230, 100], [40, 255, 200]), [1, 2], LINEAR, w)
    assert not merged.quality.any()
    assert np.allclose(merged.E, [[20 / 128, 230 / 128, 100 / 128]], rtol=1e-4)


def test_the_response_decides_each_channel():
    images = np.full((2, 3, 4, 3), 100, np.uint8)
    E = merge(images, [1, 1], np.stack([FILM, LINEAR, FILM + 1], axis=-1))
    assert np.allclose(E, np.exp([FILM[100], LINEAR[100], FILM[100] + 1]), rtol=1e-5)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"images": np.zeros((2, 4, 5))}, "uint8 or uint16"),
        ({"times": [1]}, "expected 2 exposure times"),
        ({"times": [1, 0]}, "positive exposure times"),
        ({"times": [1, np.nan]}, "positive exposure times"),
        ({"g": np.full(256, np.nan)}, "finite table"),
        ({"g": np.zeros((256, 2))}, r"response \(n,\) or \(n, 3\)"),
        (
            {"images": np.zeros((2, 4, 5), np.uint8), "g": np.zeros((256, 3))},
            r"response \(n,\) for gray",
        ),
        ({"w": -np.ones(256)}, "not negative"),
        ({"w": np.zeros(256)}, "not all 0"),
        ({"w": np.ones((256, 3))}, r"weights \(n,\)"),
        ({"method": "guess"}, "one of the methods log, likelihood, mean, shot, got 'guess'"),
        ({"valid": np.ones((4, 5))}, r"mask of shape \(2, 4, 5\), got"),
        ({"top": 0}, "top as a fraction"),
        ({"top": 1.5}, "top as a fraction"),
    ],
)
def test_invalid_arguments_raise_an_error(changes, message):
    arguments = {"images": np.zeros((2, 4, 5, 3), np.uint8), "times": [1, 2], "g": FILM} | changes
    with pytest.raises(ValueError, match=message):
        merge_with_quality(**arguments)


@pytest.mark.parametrize("verb", [lesson.merge, quick.merge], ids=["lesson", "fast"])
def test_a_response_that_does_not_rise_raises_an_error(verb):
    g = np.r_[0.0, -np.ones(254), 0.0]
    with pytest.raises(ValueError, match="rise"):
        verb(np.full((2, 2, 2), 9, np.uint8), [1, 2], g)


@pytest.mark.parametrize("verb", [lesson.merge, quick.merge], ids=["lesson", "fast"])
@pytest.mark.parametrize(
    ("images", "times"),
    [
        (np.ones((2, 4, 5)), [1, 2]),
        (np.ones((2, 4), np.uint8), [1, 2]),
        (np.ones((2, 4, 5, 2), np.uint8), [1, 2]),
        (np.ones((2, 4, 5), np.uint8), [1, 0]),
        (np.ones((2, 4, 5), np.uint8), [1, 2, 3]),
    ],
)
def test_invalid_images_raise_an_error(verb, images, times):
    with pytest.raises(InputError, match="expected"):
        verb(images, times, FILM)


@pytest.mark.parametrize("verb", [lesson.merge, quick.merge], ids=["lesson", "fast"])
@pytest.mark.parametrize(
    "w", [np.full(256, np.nan), np.zeros(256), -np.ones(256), np.full(256, np.inf), [1.0]]
)
def test_weights_that_cannot_weigh_raise_an_error_instead_of_a_black_map(verb, w):
    with pytest.raises(InputError, match="expected"):
        verb(np.full((2, 4, 5), 90, np.uint8), [1, 2], FILM, w)


@pytest.mark.parametrize("verb", [lesson.merge, quick.merge], ids=["lesson", "fast"])
def test_masked_levels_raise_an_error_instead_of_being_merged(verb):
    images = np.ma.array(np.full((2, 4, 5), 90, np.uint8), mask=False)
    images[0, 1, 2] = np.ma.masked
    with pytest.raises(InputError, match="masked"):
        verb(images, [1, 2], FILM)


def test_expendable_photos_give_the_same_map():
    """The pipeline lets the fast merge free each frame's memory after it has read it."""
    rng = np.random.default_rng(3)
    images = rng.integers(0, 256, (4, 1100, 300, 3), dtype=np.uint8)
    kept = quick.merge_with_quality(images.copy(), [1, 2, 4, 8], FILM)
    released = quick.merge_with_quality(images.view(quick.Expendable), [1, 2, 4, 8], FILM)
    assert np.array_equal(kept.E, released.E) and np.array_equal(kept.quality, released.quality)
