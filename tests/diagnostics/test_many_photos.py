"""Brackets of many photos: the work for the checks grows no faster than the number of photos."""

import numpy as np
import pytest

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.diagnostics.contradictions import find_contradictions
from hdrlab.diagnostics.frame_choice import choose_spread_frames
from hdrlab.diagnostics.outlying_frames import find_outlying_frames
from hdrlab.pipeline import assemble

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
    assert not assembly.doubts
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
