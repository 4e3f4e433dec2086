"""Brackets of many photos: work grows no faster than their number, and memory as their pixels."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.diagnostics.contradictions import find_contradictions
from hdrlab.diagnostics.frame_choice import choose_spread_frames
from hdrlab.diagnostics.motion import MIN_MOVING_FRACTION, measure_motion
from hdrlab.diagnostics.outlying_frames import find_outlying_frames
from hdrlab.fast import merge as fast_merge
from hdrlab.pipeline import assemble
from hdrlab.radiance import merge as lesson_merge

SHAPE = (96, 144)


def shoot(count, stops_span=7.0):
    """Return a bracket of many photos with evenly spaced times."""
    room = scenes.room(SHAPE)
    middle = camera.times_around(room, 1)[0]
    times = middle * 2 ** np.linspace(-stops_span / 2, stops_span / 2, count)
    return camera.shoot(room, times, rng=1)


@pytest.mark.parametrize("count", [2, 5, 20, 64])
def test_chosen_photos_include_both_ends_and_stay_in_order(count):
    times = np.sort(np.random.default_rng(0).choice([1, 2, 4, 8.5], 50))
    chosen = choose_spread_frames(times, count)
    assert len(chosen) == min(count, 50)
    assert chosen[0] == 0
    assert chosen[-1] == 49
    assert np.all(np.diff(chosen) > 0)


def test_every_exposure_is_chosen_before_repeated_ones():
    times = np.sort([1.0, 2.0, 4.0] + [8.0] * 100)
    chosen = choose_spread_frames(times, 8)
    assert set(times[chosen]) == {1, 2, 4, 8}


def test_map_of_many_photos_is_that_of_some():
    many = shoot(80)
    assembly = assemble(many, align="none")
    some = assemble(shoot(8), align="none")
    assert not assembly.warnings
    ratio = np.log2(assembly.E / some.E)
    assert np.quantile(np.abs(ratio - np.median(ratio)), 0.9) < 0.05


def test_wrong_times_among_many_photos_are_named():
    many = shoot(80)
    factor = np.ones(80)
    factor[40:44] = 2
    times = np.maximum.accumulate(many.times * factor)
    found = find_contradictions(many.images, times)
    assert len(found.stops) == 80
    assert np.isfinite(found.stops).sum() <= 64
    assert found.wrong
    assert set(found.wrong) <= set(range(38, 56))  # up to where the true times are as long


def test_photo_of_another_scene_among_many_is_found():
    many = shoot(20)
    images = many.images.copy()
    images[9] = images[9, ::-1, ::-1]
    outliers, _ = find_outlying_frames(images, many.times)
    assert outliers == (9,)


def measure_peak_bytes(taken):
    tracemalloc.start()
    assembly = assemble(taken, align="none")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert not assembly.warnings
    return peak


@pytest.mark.papers
def test_more_photos_need_no_more_memory_than_their_pixels():
    some = shoot(100)
    many = shoot(300)
    growth = measure_peak_bytes(many) - measure_peak_bytes(some)
    assert growth < many.images.nbytes - some.images.nbytes


@pytest.mark.parametrize("method", ["log", "likelihood", "mean", "shot"])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_merge_of_many_photos_is_that_of_the_lesson(method, dtype):
    rng = np.random.default_rng(3)
    levels = np.iinfo(dtype).max + 1
    times = 2 ** np.linspace(-4, 4, 45)
    light = np.geomspace(0.01, 20, 11 * 13 * 3).reshape(11, 13, 3)
    exposures = light * times[:, None, None, None] * levels / 4
    images = (exposures + rng.normal(0, 2, exposures.shape)).clip(0, levels - 1).astype(dtype)
    images[:, 0, 0] = 0
    images[:, 0, 1] = levels - 1
    valid = rng.random(images.shape[:3]) > 0.2
    g = np.log((np.arange(levels) + 0.5) / levels)
    order = rng.permutation(len(times))
    options = {"method": method, "valid": valid[order]}
    given = (images[order], times[order], g)
    expected = lesson_merge.merge_with_quality(*given, **options)
    merged = fast_merge.merge_with_quality(*given, **options)
    np.testing.assert_allclose(merged.E, expected.E, rtol=1e-4)
    assert np.array_equal(merged.quality, expected.quality)


@pytest.mark.papers
def test_something_that_moved_through_many_photos_is_found_and_removed():
    many = shoot(80)
    images = many.images.copy()
    y, x = np.mgrid[: SHAPE[0], : SHAPE[1]]
    for j, image in enumerate(images):
        is_ball = (y - 50) ** 2 + (x - 50 - 20 * (j // 40)) ** 2 < 9**2
        image[is_ball] = image[np.roll(is_ball, 40, axis=1)]
    g = assemble(many, align="none").g
    motion = measure_motion(images, many.times, g, np.ones(256))
    assert motion.fraction > MIN_MOVING_FRACTION
    moved = assemble(replace(many, images=images), align="none", ghosts="regions")
    assert moved.moving[50, 50] or moved.moving[50, 70]
