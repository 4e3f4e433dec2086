"""Motion that a median over levels does not see."""

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from benchmarks.verdicts import brackets, ills
from hdrlab import pipeline
from hdrlab.capture import movers, responses
from hdrlab.core import threads
from hdrlab.diagnostics import motion
from hdrlab.diagnostics.causes import warn_of_contradictions
from hdrlab.diagnostics.contradictions import Contradictions

pytestmark = pytest.mark.papers

WALL = np.full((60, 90), 0.5, np.float32)
G, W = responses.true_g("film"), np.ones(256)


BALL = movers.ball((60, 90), (30, 45), 12, 0.1, stripes=0)


def share(step, **change):
    taken = movers.shoot(WALL, BALL, movers.path(3, (0, step)), [0.25, 0.5, 1.0]).bracket
    given = {"images": taken.images, "times": taken.times, "g": G, "w": W} | change
    return motion.measure_motion(**given).fraction


def bands(axis, cycles=3, size=0.2):
    """Bands of a wall under lamps whose light differs from row to row (0) or column to column (1)."""
    n = WALL.shape[axis]
    phases = [2 * np.pi * (cycles * np.arange(n) / n + j / 3) for j in range(3)]
    lamps = [1 + size * np.sin(one) for one in phases]
    times = np.array([0.25, 0.5, 1.0])
    light = [
        WALL * (one[:, None] if axis == 0 else one) * t for one, t in zip(lamps, times, strict=True)
    ]
    Z = np.interp(np.log(light), G, np.arange(256)).round().astype(np.uint8)
    return motion.measure_motion(Z, times, G, W).band_stops


def test_a_larger_motion_has_a_larger_moving_fraction():
    assert share(0) == 0
    assert motion.MIN_MOVING_FRACTION < share(15) < share(30) < 0.5


@pytest.mark.quick
def test_gray_photos_are_subsampled_like_color_photos(monkeypatch):
    gray = movers.shoot(WALL, BALL, movers.path(3, (0, 30)), [0.25, 0.5, 1.0]).bracket.images
    wide = gray.repeat(2, axis=1).repeat(2, axis=2)
    monkeypatch.setattr(motion, "MAX_PIXELS", WALL.size)
    assert (
        share(30, images=wide) == share(30, images=np.stack([wide] * 3, axis=-1)) == share(30) > 0
    )


def test_masked_pixels_do_not_count_as_motion():
    shown = np.ones((3, 60, 90), bool)
    shown[1:] = False
    assert share(30, valid=shown) == 0


def test_a_wrong_exposure_time_is_not_reported_as_motion():
    assert share(0, times=[0.25, 0.7, 1.0]) == 0


def test_times_that_do_not_fit_the_photographs_are_an_error():
    with pytest.raises(ValueError, match="3 exposure times"):
        share(30, times=[1.0, 2.0])


@pytest.mark.parametrize("ill", ["wind", "water"])
def test_moving_leaves_and_water_are_found_although_the_spread_is_small(ill, tmp_path):
    taken = brackets.shoot(brackets.plan(tmp_path, 3), ills.ILLS[ill])
    found = pipeline.assemble(taken, align="none")
    assert found.spread < 0.1
    assert found.moving is not None or any(
        "--ghosts regions" in warning for warning in found.warnings
    )


def test_a_still_scene_after_sharpening_and_jpeg_is_not_motion(tmp_path):
    found = pipeline.assemble(brackets.shoot(brackets.plan(tmp_path, 3)), align="none")
    assert found.moving is None and found.warnings == ()


def test_bright_panes_beside_dark_walls_are_not_motion(tmp_path):
    plan = brackets.plan(tmp_path, 12, sound="plain")
    assert plan.scene == "chapel"
    found = pipeline.assemble(brackets.shoot(plan), align="none")
    assert found.moving is None and found.warnings == ()


def test_lamps_that_flicker_make_bands_across_the_rows_and_not_along_them():
    rms = 0.2 / np.sqrt(2) / np.log(2)
    assert bands(0) == pytest.approx(rms, rel=0.2)
    assert bands(1) == 0


def test_light_that_differs_from_the_top_to_the_bottom_makes_no_bands():
    assert bands(0, cycles=0.5) < motion.MIN_BAND_STOPS < bands(0, size=0.1)


@pytest.fixture(scope="module")
def flickering(tmp_path_factory):
    """flickering(i) -> a simulated bracket under lamps that flicker."""

    @cache
    def shoot(i):
        plan = brackets.plan(tmp_path_factory.mktemp("flicker"), i)
        return brackets.shoot(plan, ills.ILLS["flicker"])

    return shoot


def verdict(taken):
    """Return the only warning of a map, without its numbers."""
    (warning,) = pipeline.assemble(taken, align="none").warnings
    return re.sub(r"\d", "", warning)


@pytest.mark.papers
@pytest.mark.parametrize("i", [3, 5])
def test_flicker_is_reported(i, flickering):
    assert "lamps flicker" in verdict(flickering(i))


@pytest.mark.papers
@pytest.mark.parametrize("i", [3, 5])
def test_the_verdict_on_flicker_is_the_same_for_noise_of_a_level_in_a_few_pixels(i, flickering):
    taken = flickering(i)
    rng = np.random.default_rng(1)
    images = taken.images.copy()
    chosen = (rng.random(images.shape) < 1e-4) & (images > 0) & (images < 255)
    images[chosen] += rng.choice([1, 255], size=chosen.sum()).astype(np.uint8)
    assert verdict(replace(taken, images=images)) == verdict(taken)


@pytest.mark.papers
def test_the_verdict_on_flicker_is_the_same_for_other_memory_layouts(flickering):
    taken = flickering(3)
    padded = np.zeros((len(taken.images), *(2 * n for n in taken.images.shape[1:3]), 3), np.uint8)
    padded[:, ::2, ::2] = taken.images
    expected = verdict(taken)
    assert verdict(replace(taken, images=np.asfortranarray(taken.images))) == expected
    assert verdict(replace(taken, images=padded[:, ::2, ::2])) == expected


@pytest.mark.papers
def test_the_verdict_on_flicker_is_the_same_for_other_exposure_times_within_a_millionth(flickering):
    taken = flickering(3)
    noise = 1 + 1e-6 * np.random.default_rng(2).standard_normal(len(taken.times))
    assert verdict(replace(taken, times=taken.times * noise)) == verdict(taken)


@pytest.mark.papers
def test_the_verdict_on_flicker_is_the_same_with_one_thread(flickering, monkeypatch):
    expected = verdict(flickering(3))
    monkeypatch.setattr(threads, "MIN_PIXELS_FOR_THREAD", 1)
    for count in (1, 4):
        monkeypatch.setattr(threads, "THREADS", count)
        assert verdict(flickering(3)) == expected


def contradictions_of(stops=0.0, regions=0.0):
    return Contradictions(
        stops=np.array([0.0, stops, 0.0, 0.0]),
        regions=np.full(3, regions),
        significance=np.full(3, 9.0),
    )


@pytest.mark.parametrize(
    ("regions", "says_flicker", "says_parts"),
    [(0.03, True, False), (0.08, True, True), (0.12, True, True), (0.3, False, True)],
)
def test_between_flicker_and_light_that_changed_in_parts_there_is_a_band_without_a_decision(
    regions, says_flicker, says_parts
):
    text = warn_of_contradictions(
        contradictions_of(regions=regions), "abcd", 0.2, band_stops=motion.MIN_BAND_STOPS + 0.01
    )
    assert ("lamps flicker" in text) == says_flicker
    assert ("parts of the image" in text) == says_parts


@pytest.mark.parametrize(("stops", "says_flicker"), [(0.3, True), (0.9, False)])
def test_between_flicker_and_wrong_times_there_is_a_band_without_a_decision(stops, says_flicker):
    text = warn_of_contradictions(
        contradictions_of(stops=stops), "abcd", 0.2, band_stops=motion.MIN_BAND_STOPS + 0.01
    )
    assert "b by +" in text
    assert ("lamps flicker" in text) == says_flicker


def test_bands_of_rows_that_columns_show_nearly_as_much_never_appear_all_at_once():
    """A jump of the measure would make flicker of nothing where a computer rounds differently."""
    times = np.array([0.25, 0.5, 1.0])
    y, x = np.indices(WALL.shape)
    measured = []
    for ratio in np.linspace(1.8, 3.2, 40):
        images = []
        for j, time in enumerate(times):
            rows = 0.3 * np.sin(2 * np.pi * (3 * y / WALL.shape[0] + j / 3))
            columns = 0.3 / ratio * np.sin(2 * np.pi * (3 * x / WALL.shape[1] + j / 3))
            light = np.log(WALL * time * (1 + rows) * (1 + columns))
            images.append(np.interp(light, G, np.arange(256)).round().astype(np.uint8))
        measured.append(motion.measure_motion(np.stack(images), times, G, W).band_stops)
    assert measured[0] == 0
    assert measured[-1] > 3 * motion.MIN_BAND_STOPS
    assert np.diff(measured).max() < 0.2 * measured[-1]
