"""The stages of the pipeline with inconsistent photos, wrong times and moving objects."""

from dataclasses import replace

import numpy as np
import pytest

from hdrlab.core.bracket import bracket
from hdrlab.diagnostics import outlying_frames
from hdrlab.diagnostics.exposure_times import Estimate
from hdrlab.pipeline import corrections, timing
from hdrlab.pipeline.assembly import Assembly

TAKEN = bracket(np.full((5, 20, 20), 9, np.uint8), [1, 2, 3, 4, 5], "abcde")
STATE = Assembly(
    stage="merge",
    bracket=TAKEN,
    offsets=np.zeros((5, 2), int),
    g=np.zeros(256),
    E=np.zeros((20, 20), np.float32),
    quality=np.zeros((20, 20), np.uint8),
    homographies=np.stack([np.eye(3)] * 5),
)


@pytest.mark.parametrize(
    ("rivals", "relative", "doubted"),
    [((), False, False), ((1, 2), False, True), ((1, 2), True, False)],
)
def test_a_frame_that_contradicts_all_others_is_dropped_with_a_warning_only_if_it_is_ambiguous(
    rivals, relative, doubted, monkeypatch
):
    monkeypatch.setattr(outlying_frames, "find_outlying_frames", lambda *_, **__: ((3,), rivals))
    assembly = corrections.drop_outlying_frames(STATE, has_relative_times=relative)
    assert assembly.bracket.names == ("a", "b", "c", "e")
    assert (len(assembly.warnings), len(assembly.notes)) == (doubted, not doubted)
    (message,) = assembly.warnings + assembly.notes
    assert ": d;" in message and ("b or c" in message) == doubted


def test_more_than_one_dropped_frame_is_a_warning(monkeypatch):
    monkeypatch.setattr(outlying_frames, "find_outlying_frames", lambda *_, **__: ((0, 3), ()))
    assembly = corrections.drop_outlying_frames(STATE, has_relative_times=True)
    assert assembly.bracket.names == ("b", "c", "e")
    assert assembly.warnings and not assembly.notes


@pytest.mark.parametrize(
    ("spread", "other", "replaced"), [(0.5, 0.0, False), (0.51, 0.25, False), (0.51, 0.24, True)]
)
def test_relative_times_replace_those_of_a_worthless_map_if_they_halve_the_limit_of_spread(
    spread, other, replaced, monkeypatch
):
    def correct(taken, response, stated_spread=None):
        estimate = Estimate(taken.times, np.zeros(5), False, "")
        left = other if stated_spread is None else spread
        return timing.CorrectedTimes(estimate=estimate, spread=left)

    relative = replace(TAKEN, times=2.0 ** np.arange(5))
    monkeypatch.setattr(timing, "correct_times", correct)
    monkeypatch.setattr(timing, "estimate_relative_times", lambda taken: relative)
    refined = timing.refine_times(STATE, "auto", 0.7)
    assert np.array_equal(refined.bracket.times, (relative if replaced else TAKEN).times)
    # close to a limit the stated times stay, with a warning that names neither times as wrong
    (warning,) = refined.warnings
    assert ("0.70 stops" in warning) == replaced
    assert ("the pixels do not show which" in warning) == (not replaced)


def test_photos_that_get_darker_with_longer_times_are_named():
    ramp = np.linspace(20, 240, 400).reshape(20, 20)
    images = np.stack([ramp * share for share in (0.5, 0.7, 1, 0.6, 0.8)]).astype(np.uint8)
    with pytest.raises(ValueError, match=r"c \(3 s\) and d \(4 s\)"):
        timing.complete_times(replace(TAKEN, images=images), "stated")
