"""Optional corrections: leave out photos that contradict the others, remove ghosts and glare."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from hdrlab.core.arrays import F64
from hdrlab.diagnostics import outlying_frames
from hdrlab.diagnostics.doubts import warning_text
from hdrlab.pipeline.assembly import Assembly, select_photos
from hdrlab.radiance import flare
from hdrlab.radiance.merge import Merged


def drop_outlying_frames(state: Assembly, *, has_relative_times: bool) -> Assembly:
    """Return the Assembly without the photos that contradict all others, and a note or a warning.

    It is a warning where another photo may be the wrong one just as well. Relative times are as
    rough as all others, so with them it is a note in any case.
    """
    bracket = state.bracket
    outliers, rivals = outlying_frames.find_outlying_frames(
        bracket.images, bracket.times, valid=bracket.valid
    )
    if not outliers:
        return state
    names = ", ".join(bracket.names[j] for j in outliers)
    text = warning_text("contrary", frames=names)
    if rivals and not has_relative_times:
        rival_names = " or ".join(bracket.names[j] for j in rivals)
        state = state.with_doubt(text + warning_text("rivals", frames=rival_names))
    else:
        state = state.with_note(text)
    kept = np.delete(np.arange(len(bracket.times)), outliers)
    return select_photos(state, kept)


def remove_ghosts(
    state: Assembly, mode: str, pixel_weights: F64, merge: Callable[..., Merged]
) -> Assembly:
    """Return the Assembly without ghosts of things that moved; `mode` is the option `ghosts`.

    With "reference", the reference is the middle photo.
    """
    # Imported here, because SciPy's filters take a fifth of a second to import.
    from hdrlab.radiance.deghosting import ghosts

    bracket = state.bracket
    is_auto = mode == "auto"
    result = ghosts.remove_ghosts(
        bracket.images,
        bracket.times,
        state.g,
        pixel_weights,
        fixed=len(bracket.images) // 2 if mode == "reference" else None,
        most=ghosts.WIDESPREAD if is_auto else np.inf,
        merged=Merged(state.E, state.quality),
        valid=bracket.valid,
        merge=merge,
    )
    state = replace(state, stage="ghosts")
    if is_auto and 100 * np.mean(result.labels > 0) >= ghosts.WIDESPREAD:
        return state
    state = replace(state, E=result.E, quality=result.quality, moving=result.labels)
    return state.with_note(ghosts.note(result, bracket.names))


def remove_glare(state: Assembly) -> Assembly:
    """Return the Assembly without veiling glare, the light that the lens scattered."""
    result = flare.remove_glare(state.E)
    state = replace(state, stage="flare", E=result.E, glare=result.region)
    return state.with_note(flare.note(result))
