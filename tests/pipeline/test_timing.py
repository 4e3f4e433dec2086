"""Photos without times: relative times from their order in brightness or from their histograms."""

from dataclasses import replace

import numpy as np
import pytest

from hdrlab import pipeline, scenes
from hdrlab.capture import camera
from hdrlab.core.bracket import bracket
from hdrlab.errors import InputError
from hdrlab.pipeline import recovery, registration, stages, timing
from hdrlab.pipeline.timing import (
    complete_times,
    estimate_relative_times,
    refine_times,
    space_by_stops,
)

pytestmark = pytest.mark.papers


@pytest.fixture(scope="module")
def room():
    return scenes.room((96, 144))


@pytest.fixture(scope="module")
def taken(room):
    return camera.shoot(room, camera.times_around(room, 5, stops=2), rng=1)


def test_spacing_by_stops_gives_the_same_map_as_the_true_times(taken):
    shuffled = bracket(taken.images[[3, 0, 4, 2, 1]], np.ones(5))
    spaced = space_by_stops(shuffled, 2)
    ratio = pipeline.assemble(spaced).E / pipeline.assemble(taken).E
    assert np.allclose(ratio, np.median(ratio), rtol=1e-2)


@pytest.mark.quick
def test_times_by_stops_rise_from_the_darkest_photo_to_the_brightest(taken):
    shuffled = bracket(taken.images[[3, 0, 4, 2, 1]], np.ones(5))
    spaced = space_by_stops(shuffled, 2)
    assert spaced.times.tolist() == [1, 4, 16, 64, 256]
    assert np.array_equal(spaced.images, taken.images)


@pytest.mark.quick
def test_steps_in_stops_may_differ_and_must_be_positive(taken):
    assert space_by_stops(taken, [1, 2, 1, 3]).times.tolist() == [1, 2, 8, 16, 128]
    with pytest.raises(ValueError, match="positive steps"):
        space_by_stops(taken, -1)


@pytest.mark.parametrize("response", ["film", "srgb", "gamma"])
def test_relative_times_have_the_right_order_and_roughly_the_right_steps(room, response):
    taken = camera.shoot(
        room, camera.times_around(room, 5, stops=2), camera.Camera(response=response), rng=1
    )
    shuffled = bracket(taken.images[[3, 0, 4, 2, 1]], np.ones(5))
    estimated = estimate_relative_times(replace(shuffled, luminance_of_unit=0.5))
    steps = np.diff(np.log2(estimated.times))
    assert estimated.has_relative_times and not taken.has_relative_times
    assert estimated.luminance_of_unit is None  # relative times do not tell how bright it was
    assert np.all((steps > 1) & (steps < 3.2))


def test_relative_times_of_a_linear_camera_are_right(room):
    linear = camera.Camera(response="linear", bits=16)
    taken = camera.shoot(room, camera.times_around(room, 4, stops=2), linear, rng=1)
    steps = np.diff(np.log2(estimate_relative_times(replace(taken, times=np.ones(4))).times))
    assert np.allclose(steps, 2, atol=0.1)


def test_equal_times_of_different_photographs_are_estimated_with_a_warning(taken):
    assembly = pipeline.assemble(replace(taken, times=np.full(5, 0.01)))
    assert "relative" in assembly.warnings[0]
    assert "--stops" in assembly.warnings[0]
    assert np.all(np.diff(assembly.bracket.times) > 0) and assembly.spread < 0.1
    assert assembly.bracket.has_relative_times
    with pytest.raises(ValueError, match="at least two different exposures"):
        pipeline.assemble(replace(taken, times=np.full(5, 0.01)), times="stated")


def test_warnings_of_damaged_photos_survive_an_estimate_of_the_times(taken):
    damaged = replace(taken, times=np.full(5, 0.01), damaged=("b.jpg is damaged; it was left out",))
    assert complete_times(damaged, "correct").bracket.damaged == damaged.damaged


def test_a_burst_of_one_exposure_raises_an_error(room):
    burst = camera.shoot(room, [0.002] * 4, camera.Camera(full_well=20_000), rng=1)
    with pytest.raises(ValueError, match="at least two different exposures"):
        pipeline.assemble(burst)


@pytest.mark.parametrize("order", [[4, 3, 2, 1, 0], [2, 0, 4, 1, 3], [1, 0, 2, 3, 4]])
def test_times_in_the_wrong_order_are_estimated_with_a_warning_unless_they_are_to_be_kept(
    taken, order
):
    shuffled = bracket(taken.images, taken.times[order])
    with pytest.raises(InputError, match="frame . .* and frame .*--times estimate"):
        complete_times(shuffled, "stated")
    corrected = complete_times(shuffled, "correct")
    estimated = complete_times(shuffled, "estimate")
    for completed in (corrected, estimated):
        assert np.array_equal(completed.bracket.images, taken.images)
        assert completed.bracket.has_relative_times
    assert "relative" in corrected.warnings[0]
    assert "relative" in estimated.notes[0]
    assert not estimated.warnings
    assembly = pipeline.assemble(shuffled, align="none")
    assert assembly.warnings
    assert assembly.spread < 0.1


def test_true_times_are_not_changed_and_give_no_note(taken):
    assembly = pipeline.assemble(taken)
    assert assembly.bracket.times.tobytes() == taken.times.tobytes()
    assert not assembly.warnings and not assembly.fallback
    assert assembly.notes == ()


def test_rough_times_are_corrected_unless_times_is_stated():
    room = scenes.room((280, 420))
    taken = camera.shoot(room, camera.times_around(room, 5, stops=1.5))
    rough = replace(taken, times=taken.times * [1, 1, 1.1, 1, 1])
    assembly = pipeline.assemble(rough, align="none", times="correct")
    stated = pipeline.assemble(rough, align="none", times="stated")
    assert stated.bracket.times.tobytes() == rough.times.tobytes()
    assert assembly.spread < stated.spread and "times estimated" in assembly.notes[0]


@pytest.mark.quick
def test_a_rough_time_is_corrected_before_the_response_is_found():
    room = scenes.room((200, 300))
    taken = camera.shoot(room, camera.times_around(room, 4, stops=1.5), rng=1)
    rough = replace(taken, times=taken.times * [1, 1, 1.1, 1])
    assembly = next(
        stage for stage in stages.assemble_steps(rough, align="none") if stage.stage == "times"
    )
    assert np.abs(np.log2(assembly.bracket.times / taken.times)).max() < 0.03
    assert assembly.g is None and "most frame 3 -0.1" in assembly.notes[0]  # of log2(1.1) stops


@pytest.fixture(scope="module")
def mistaken():
    """Five photos whose stated times are all wrong, except those of the first and the last."""
    room = scenes.room((150, 219))
    times = camera.times_around(room, 5, stops=2)
    return bracket(camera.shoot(room, times).images, times * [1, 2.2, 0.7, 1.3, 1], list("abcde"))


def test_misaligned_photos_correct_no_times_and_report_no_contradictions(mistaken, monkeypatch):
    def lie_apart(*arguments, **named):
        aligned = align_bracket(*arguments, **named)
        return replace(aligned, warnings=("a and b could not be aligned",), is_misaligned=True)

    align_bracket = registration.align_bracket
    assert len(pipeline.assemble(mistaken, align="none").warnings) == 2
    monkeypatch.setattr(registration, "align_bracket", lie_apart)
    apart = pipeline.assemble(mistaken, align="none")
    assert apart.warnings == ("a and b could not be aligned",)
    assert np.array_equal(apart.bracket.times, mistaken.times)


def test_times_that_leave_nothing_to_compare_are_reported_without_a_number(mistaken):
    (state, *_) = pipeline.assemble_steps(
        replace(mistaken, times=2.0 ** np.arange(5) / 64), align="none"
    )
    (warning,) = refine_times(state, "auto", np.inf).warnings
    assert "inf" not in warning and "relative exposure times" in warning


@pytest.mark.parametrize(("factor", "is_replaced"), [(0.9, True), (1.05, False)])
def test_close_to_the_limit_of_a_replacement_the_stated_times_stay_with_a_warning(
    factor, is_replaced, monkeypatch
):
    """So the verdict on the times is never the opposite on another computer."""
    taken = replace(scenes.photographs((320, 240)), times=1 / np.array([1000, 120, 60, 15, 8, 4]))
    (state, *_) = pipeline.assemble_steps(taken, align="none", times="stated")
    spread = recovery.choose_response("auto", state.bracket).spread
    corrected = timing.correct_times(state.bracket, "auto", spread)
    monkeypatch.setattr(timing, "MIN_WORTHLESS_STOPS", factor * corrected.spread)
    refined = refine_times(state, "auto", spread)
    assert refined.bracket.has_relative_times == is_replaced
    text = " ".join(refined.warnings)
    assert "the stated times contradict the pixels" in text
    assert ("the pixels do not show which" in text) == (not is_replaced)
