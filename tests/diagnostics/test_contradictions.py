"""Contradictions between photos and their times: invariances and closed forms."""

import numpy as np
import pytest

from benchmarks.verdicts import brackets
from hdrlab import pipeline, scenes
from hdrlab.capture import camera
from hdrlab.diagnostics import causes, contradictions, exposure_times, flat_patches, plausibility
from hdrlab.errors import CalibrationError

WRONG = np.array([1, 1, 2, 1, 1])


@pytest.fixture(scope="module")
def taken():
    room = scenes.room((140, 210))
    return camera.shoot(room, camera.times_around(room, 5, stops=1.5), rng=1)


@pytest.fixture(scope="module")
def found(taken):
    return contradictions.find_contradictions(taken.images, taken.times * WRONG)


def test_the_photo_with_a_wrong_time_is_named_and_its_error_measured(found):
    assert found.wrong == (2,)
    assert found.stops[2] == pytest.approx(-1, abs=0.05)


def test_the_unit_of_the_times_does_not_matter(taken, found):
    scaled = contradictions.find_contradictions(taken.images, 1000 * taken.times * WRONG)
    assert np.allclose(scaled.stops, found.stops, atol=1e-6)
    assert scaled.cost == pytest.approx(found.cost, abs=1e-6)


def test_16_bits_of_the_same_photos_give_the_same_result(taken, found):
    images = taken.images.astype(np.uint16) * 257
    wide = contradictions.find_contradictions(images, taken.times * WRONG)
    assert np.allclose(wide.stops, found.stops, atol=1e-6)
    assert np.allclose(wide.regions, found.regions, atol=1e-6)


def test_memory_layout_does_not_matter(taken, found):
    images = np.asfortranarray(taken.images)
    other = contradictions.find_contradictions(images, taken.times * WRONG)
    assert np.array_equal(other.stops, found.stops)


def test_masked_pixels_do_not_count(taken):
    images = taken.images.copy()
    valid = np.ones(images.shape[:3], bool)
    images[:, :30] = np.arange(40, 215, 35)[:, None, None, None]
    valid[:, :30] = False
    masked = contradictions.find_contradictions(images, taken.times, valid=valid)
    assert masked.wrong == ()
    assert causes.warn_of_contradictions(masked, "abcde") == ""


def test_an_error_shared_by_all_photos_has_no_cost(taken):
    assert contradictions.measure_cost(taken.images, np.ones(5)) == pytest.approx(0, abs=1e-6)
    assert contradictions.measure_cost(taken.images, np.array([0, 0, 1, 0, 0])) > 0.1


@pytest.mark.parametrize(
    ("informative", "run"),
    [
        ([True, True, False, True], (0, 2)),
        ([False, True, False, True, True, True], (3, 6)),
        ([True, False, True], (0, 1)),
        ([False, False], (0, 0)),
    ],
)
def test_find_longest_run_returns_the_first_of_the_longest_runs(informative, run):
    assert contradictions.find_longest_run(np.array(informative)) == run


def test_estimated_times_scale_with_the_stated_ones(taken):
    rough = taken.times * [1, 1, 1.1, 1, 1]
    first = exposure_times.estimate_times(taken.images, rough)
    second = exposure_times.estimate_times(taken.images, 1000 * rough)
    assert first.accepted
    assert second.accepted
    assert np.allclose(second.times, 1000 * first.times, rtol=1e-6)


def test_a_uniform_wall_is_flat_and_clipped_patches_are_not_measured():
    images = np.stack([np.full((60, 90), value, np.uint8) for value in (80, 255)])
    found = flat_patches.find_flat_patches(images)
    assert found.flat.all()
    assert np.all(found.Z[0] == 80)
    assert np.all(found.Z[1] == 0)


def test_a_response_that_the_photos_contradict_is_a_calibration_error(taken):
    g = np.log(np.maximum(np.arange(256), 0.25) / 128)
    with pytest.raises(CalibrationError, match="between"):
        plausibility.validate_response(g, taken.images, taken.times**8)


@pytest.mark.papers
@pytest.mark.parametrize(
    ("sound", "number"), [("by hand, lamps, dark ground", 0), ("bright lamps", 12)]
)
def test_few_flat_patches_accuse_no_lens_and_no_white_balance(sound, number, tmp_path):
    plan = brackets.plan(tmp_path, number, sound=sound, seed=2)
    assert pipeline.assemble(brackets.shoot(plan)).warnings == ()


@pytest.mark.parametrize(
    ("times", "recommends_estimate"), [("kept", True), ("corrected", False), ("relative", False)]
)
def test_an_estimate_of_the_times_is_recommended_only_where_none_was_made(
    found, times, recommends_estimate
):
    text = causes.warn_of_contradictions(found, "abcde", times=times)
    assert "c by" in text
    assert ("--times estimate" in text) == recommends_estimate
    assert ("--stops" in text) == (times == "relative")


def test_a_change_of_the_corners_never_appears_all_at_once():
    explained = np.linspace(0, 1, 1001)
    weights = np.array([contradictions.weigh_corners(fraction) for fraction in explained])
    assert weights[0] == 0 and weights[-1] == 1
    assert 0 <= np.diff(weights).min() and np.diff(weights).max() < 0.02
