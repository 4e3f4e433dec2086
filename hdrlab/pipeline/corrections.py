"""Optional corrections: leave out photos that contradict the others, remove ghosts and glare."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from hdrlab.core.arrays import F32, F64, ArrayLike
from hdrlab.diagnostics import outlying_frames
from hdrlab.diagnostics.warning_texts import warning_text
from hdrlab.pipeline import dark_pixels
from hdrlab.pipeline.assembly import Assembly, select_photos
from hdrlab.radiance import flare
from hdrlab.radiance.merge import Merged


def drop_outlying_frames(
    state: Assembly, *, has_relative_times: bool, keeps_times: bool = False
) -> Assembly:
    """Return the Assembly without the photos that contradict all others, and a note or a warning.

    It is a warning where another photo may be the wrong one just as well, and where more than one
    photo is left out. Relative times are as rough as all others, so with them rivals are no reason
    for a warning. A photo that alone holds highlights gets another time instead, with a warning, if
    that makes it agree with the others. With `keeps_times`, it stays with the time that it has.
    """
    bracket = state.bracket
    outliers, rivals = outlying_frames.find_outlying_frames(
        bracket.images, bracket.times, valid=bracket.valid
    )
    if not outliers:
        return state
    agreeing = [j for j in range(len(bracket.times)) if j not in outliers]
    dropped = []
    for frame in outliers:
        corrected = _correct_time_for_highlights(state, frame, agreeing)
        if corrected is None:
            dropped.append(frame)
        elif not keeps_times:
            state = corrected
    if not dropped:
        return state
    names = ", ".join(bracket.names[j] for j in dropped)
    text = warning_text("contrary", frames=names)
    has_rivals = bool(rivals) and not has_relative_times
    if has_rivals:
        rival_names = " or ".join(bracket.names[j] for j in rivals)
        text += warning_text("rivals", frames=rival_names)
    is_warning = has_rivals or len(dropped) > 1
    state = state.with_warning(text) if is_warning else state.with_note(text)
    kept = np.delete(np.arange(len(bracket.times)), dropped)
    return select_photos(state, kept)


def _correct_time_for_highlights(
    state: Assembly, frame: int, agreeing: list[int]
) -> Assembly | None:
    """Return the Assembly with the time of a photo that alone holds highlights, and a warning.

    Return None if the photo holds none, if no other time makes it agree with the others, or if that
    time is not between those of its neighbors.
    """
    bracket = state.bracket
    highlights = outlying_frames.find_highlights_of(bracket.images, frame, valid=bracket.valid)
    if not highlights.any():
        return None
    stops = outlying_frames.measure_time_error(
        bracket.images, bracket.times, frame, agreeing, valid=bracket.valid
    )
    if np.isnan(stops):
        return None
    times = bracket.times.copy()
    times[frame] /= 2**stops
    if np.any(np.diff(times) < 0):
        return None
    state = replace(state, bracket=replace(bracket, times=times))
    text = warning_text("highlights", frame=bracket.names[frame], stops=-stops)
    return state.with_warning(text)


def remove_ghosts(
    state: Assembly,
    mode: str,
    pixel_weights: F64,
    merge: Callable[..., Merged],
    *,
    certainty: F32 | None = None,
    neutral: ArrayLike = (1, 1, 1),
    is_misaligned: bool = False,
) -> Assembly:
    """Return the Assembly without ghosts of things that moved; `mode` is the option `ghosts`.

    With "reference", the reference is the middle photo. A warning says if most of the image moved.
    With "auto", nothing changes if nothing moved, or if most of the image differs between photos that
    could not be aligned, because that is not motion. Pixels without a color fade to `neutral`, see
    `dark_pixels.measure_color_certainty` and `dark_pixels.measure_neutral`.
    """
    # Imported here, because SciPy's filters take a fifth of a second to import.
    from hdrlab.pipeline import deghosting
    from hdrlab.radiance.deghosting import ghosts

    bracket = state.bracket
    result = deghosting.remove_ghosts(
        bracket,
        state.g,
        pixel_weights,
        merged=Merged(state.E, state.quality),
        merge=merge,
        fixed=len(bracket.images) // 2 if mode == "reference" else None,
    )
    percent = 100 * np.mean(result.labels > 0)
    is_widespread = percent >= ghosts.WIDESPREAD_PERCENT
    if mode == "auto" and (not len(result.references) or (is_misaligned and is_widespread)):
        return state
    E = result.E
    if certainty is not None:
        is_new = np.reshape(state.E != E, (*E.shape[:2], -1)).any(axis=-1)
        E = dark_pixels.fade_to_neutral(E, np.where(is_new, certainty, 1), neutral=neutral)
    record = state.record
    if record is not None:
        record = replace(record, used=result.used, references=result.references, alpha=result.alpha)
    state = replace(
        state,
        stage="ghosts",
        E=E,
        quality=result.quality,
        moving=result.labels,
        record=record,
    )
    if is_widespread:
        text = warning_text("widespread", percent=percent)
        if mode != "reference":
            text += warning_text("widespread_advice")
        state = state.with_warning(text)
    text = ghosts.note(result, bracket.names)
    return state.with_note(text) if len(result.references) else state.with_detail(text)


def remove_glare(state: Assembly) -> Assembly:
    """Return the Assembly without veiling glare, the light that the lens scattered."""
    result = flare.remove_glare(state.E)
    state = replace(state, stage="flare", E=result.E, glare=result.region)
    return state.with_note(flare.note(result))
