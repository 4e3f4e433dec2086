"""The stages from a bracket to its radiance map, one after the other.

Each stage may be a method's name or a function of the same signature, so a reader's own plugs in
wherever the library's does. `assemble_steps` yields what is known after each stage; `assemble`
returns the last of it.
"""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from hdrlab.core import steps, weights
from hdrlab.core.arrays import F64
from hdrlab.core.bracket import Bracket
from hdrlab.core.threads import map_in_threads, run_in_background
from hdrlab.diagnostics import consistency, contradictions, motion, outlying_frames
from hdrlab.diagnostics.doubts import say
from hdrlab.errors import InputError
from hdrlab.fast.merge import Expendable, merge_with_quality
from hdrlab.pipeline import recovery, registration, timing
from hdrlab.pipeline.assembly import Assembly, Method, Table, take_frames
from hdrlab.radiance import flare as lens, scales
from hdrlab.radiance.merge import METHODS, Merged

STAGES = ("align", "times", "response", "merge", "compare")
TIMES = ("correct", "stated", "estimate")
GHOSTS = ("none", "auto", "regions", "reference")
FLARE = ("none", "glare")
WEIGHTS: dict[str, Callable[[Table], Table]] = {  # by name, from the response
    "hat": lambda g: weights.hat(len(g)),
    "gaussian": lambda g: weights.gaussian(len(g)),
    "flat": lambda g: weights.flat(len(g)),
    "snr": weights.snr,
}
CONTRADICTION = (
    0.25  # stops of spread; brackets with true times stay below 0.2, scanned film included
)


def assemble(bracket: Bracket, **knobs: Any) -> Assembly:
    """Return the radiance map of a bracket, with all that was found on the way.

    Parameters
    ----------
    bracket : Bracket
        At least two photographs of different exposure.
    align : str or function
        A method of `align`, "none", or your own `align(images)` -> offsets (P, 2) of whole pixels
        or homographies (P, 3, 3). "mtb" shifts by whole pixels and leaves every pixel as it is.
        "cerman" turns too, and "homography" takes scale and tilt; both resample light, by a
        provisional response out of the histograms. "auto" is "mtb", and "cerman" or "homography"
        for the photographs that no shift lays on each other, see `pipeline.alignment`.
    response : str or function
        A method of `response`, "auto" (linear where the bracket is, else see `recovery`), or your
        own `recover(images, times, *, valid) -> g`.
    weight : {"gaussian", "hat", "flat", "snr"}
        How far the merge trusts a level. Under the Gaussian, which all but ignores the ends, the
        frames of real brackets contradict each other least.
    method : {"log", "likelihood", "mean", "shot"}
        How the frames are merged, see `radiance.merge`.
    times : {"correct", "stated", "estimate"}
        "correct" corrects rough times by the pixels, where held-out pixels prove it; times that are
        all the same, or contradict the pixels everywhere, give way to relative ones, see `timing`.
        "stated" leaves them as they are. "estimate" also replaces times that fall while the
        photographs get brighter.
    ghosts : {"none", "auto", "regions", "reference"}
        What becomes of what moved: it stays half transparent; or the map shows it as in a reference
        frame, the best exposure of each region, or the middle photograph in all: see
        `radiance.deghosting.ghosts`. "auto" is "regions" where much moved, see
        `diagnostics.motion`, and leaves a map that contradicts itself nearly everywhere.
    flare : {"none", "glare"}
        Whether veiling glare, the light that the lens scattered, is removed: see `radiance.flare`.

    Returns
    -------
    Assembly
        Read its `doubts` before you trust its `E`.

    Raises
    ------
    ValueError
        For brackets that hold fewer than two exposures, nothing that two of them see well, or times
        in the wrong order, and for names that no method has.

    Examples
    --------
    >>> from hdrlab.capture import camera
    >>> from hdrlab import scenes
    >>> photographs = camera.shoot(scenes.room((96, 144)), [0.01, 0.04, 0.16, 0.64], rng=1)
    >>> assembly = assemble(photographs)
    >>> assembly.E.shape, assembly.doubts
    ((96, 144, 3), ())
    """
    return steps.last(assemble_steps(bracket, **knobs))


def assemble_steps(
    bracket: Bracket,
    *,
    align: Method = "auto",
    response: Method = "auto",
    weight: str = "gaussian",
    method: str = "log",
    times: str = "correct",
    ghosts: str = "auto",
    flare: str = "none",
    in_place: bool = False,
    release: bool = False,
) -> Iterator[Assembly]:
    """Yield the Assembly after each of STAGES; the parameters are those of `assemble`.

    in_place : whether shifts may overwrite the photographs of `bracket`, which spares a copy of
        them all
    release : whether the merge may give their memory back, too, where nothing asks for them any
        more
    """
    asked = {
        "a weight": weight,
        "a method": method,
        "times": times,
        "ghosts": ghosts,
        "flare": flare,
    }.items()
    for (what, given), known in zip(
        asked, ((*WEIGHTS,), (*METHODS,), TIMES, GHOSTS, FLARE), strict=True
    ):
        if given not in known:
            raise InputError(f"expected {what} out of {', '.join(known)}, got {given!r}")
    bracket, said = timing.complete_times(bracket, times)
    state = registration.aligned(bracket, align, response, in_place=in_place)
    apart = bool(
        state.doubts
    )  # photographs that do not lie on each other contradict each other, too
    yield (state := state._replace(notes=(*said, *state.notes)))
    judged, contrary = state.bracket, find_contrary(state.bracket)
    choice = recovery.choose_response(response, state.bracket)
    explained = choice.spread <= timing.TRUE
    if times != "stated":
        if times == "estimate" or not explained:
            found = timing.refine_times(state, response, choice.spread)
            same = np.array_equal(found.bracket.times, state.bracket.times)
            state = state if same and (said or times == "correct") else found
        yield (state := state._replace(stage="times"))
    if not explained:
        state = leave_out_contrary(state, relative=bool(said))
        choice = recovery.choose_response(response, state.bracket)
    if state.bracket is not judged:
        contrary = find_contrary(state.bracket)
    g, doubts, fallback = recovery.find_response(response, choice, state.bracket)
    notes, doubts = (*state.notes, *choice.notes), (*state.doubts, *doubts)
    yield (state := state._replace(stage="response", g=g, notes=notes, doubts=doubts))
    w, merge = WEIGHTS[weight], partial(merge_with_quality, method=method)
    images, seconds, _, valid, _ = state.bracket
    few = np.s_[
        :, *consistency.choose_grid(images.shape[1:3])
    ]  # judged while there are photographs
    some, shown = images[few].copy(), None if valid is None else valid[few]
    E = merge(some, seconds, g, w(g), valid=shown, repair=False).E
    judges: list[Callable[..., Any]] = [
        lambda: motion.measure_motion(images, seconds, g, w(g), valid=valid),
        lambda: consistency.measure_level_exposures(some, seconds, E, valid=shown),
    ]
    (moved, bands), medians, told = (
        *map_in_threads(lambda judge: judge(), judges, pixels=images[0].size),
        contrary(),
    )
    remove = ghosts in ("regions", "reference") or (ghosts == "auto" and moved > motion.MOVED)
    if release and not remove and consistency.measure_spread(medians) <= timing.WORTHLESS:
        state = state._replace(bracket=state.bracket._replace(images=images[:0].copy()))
        images = images.view(Expendable)
    E, quality = merge(images, seconds, g, w(g), valid=valid)
    yield (state := state._replace(stage="merge", E=E, quality=quality))
    if remove:
        yield (state := deghost(state, ghosts, w, merge))
    if flare != "none":
        yield (state := remove_glare(state))
    left = (0.0, 0.0) if state.moving is not None or apart else (moved, bands)
    found = assess(state, medians, told, *left)
    yield (
        found._replace(doubts=state.doubts) if apart else found
    )  # what it says would follow from that


def find_contrary(bracket: Bracket) -> Callable[[], contradictions.Contradictions]:
    """Return a function that waits for the contradictions in a bracket, which no response is needed for."""
    find = partial(
        contradictions.find_contradictions, bracket.images, bracket.times, valid=bracket.valid
    )
    return run_in_background(find, pixels=bracket.images[0].size).result


def leave_out_contrary(state: Assembly, *, relative: bool) -> Assembly:
    """Return the Assembly without the frames that contradict all others, and a note on them, or a doubt.

    Of two frames either of which may be wrong, relative times make none: they are as rough as all
    others.
    """
    images, times, names, valid, _ = state.bracket
    found, rivals = outlying_frames.find_outlying_frames(images, times, valid=valid)
    if not found:
        return state
    said = say("contrary", frames=", ".join(names[j] for j in found))
    either = said + say("rivals", frames=" or ".join(names[j] for j in rivals))
    doubts, notes = ((either,), ()) if rivals and not relative else ((), (said,))
    state = state._replace(notes=(*state.notes, *notes), doubts=(*state.doubts, *doubts))
    return take_frames(state, np.delete(np.arange(len(times)), found))


def deghost(
    state: Assembly, way: str, w: Callable[[Table], Table], merge: Callable[..., Merged]
) -> Assembly:
    """Return the Assembly without the ghosts of what moved; the reference is the middle photograph."""
    from hdrlab.radiance.deghosting import ghosts as moving  # SciPy's filters: a fifth of a second

    images, times, names, valid, _ = state.bracket
    found = moving.remove_ghosts(
        images,
        times,
        state.g,
        w(state.g),
        fixed=len(images) // 2 if way == "reference" else None,
        most=moving.WIDESPREAD if way == "auto" else np.inf,
        merged=Merged(state.E, state.quality),
        valid=valid,
        merge=merge,
    )
    if way == "auto" and 100 * np.mean(found.labels > 0) >= moving.WIDESPREAD:
        return state._replace(stage="ghosts")
    notes = (*state.notes, moving.note(found, names))
    return state._replace(
        stage="ghosts", E=found.E, quality=found.quality, moving=found.labels, notes=notes
    )


def remove_glare(state: Assembly) -> Assembly:
    """Return the Assembly without the light that the lens scattered."""
    found = lens.remove_glare(state.E)
    notes = (*state.notes, lens.note(found))
    return state._replace(stage="flare", E=found.E, glare=found.region, notes=notes)


def calibrate(state: Assembly, x: int, y: int, reading: float) -> Assembly:
    """Return the Assembly with E in cd/m^2, by what a meter read at a pixel of it: see `scales.fit_unit`."""
    if state.quality[y : y + 1, x : x + 1].any():
        raise InputError(
            f"expected a place that the photographs measured, got {x},{y}, which none did"
        )
    k = scales.fit_unit(state.E, x, y, reading)
    note = f"1 in the map is 1 cd/m^2: {reading:g} cd/m^2 were read at {x},{y}"
    s = None if state.s is None else state.s * np.float32(k)
    return state._replace(E=state.E * np.float32(k), s=s, notes=(*state.notes, note))


def assess(
    state: Assembly, medians: F64, found: contradictions.Contradictions, moved: float, bands: float
) -> Assembly:
    """Return the Assembly with the medians of each level, and the warnings that follow from what was found.

    `moved` is the share of the picture in which ghosts are left, `bands` those of light, stops;
    each counts where nothing before it explains what is there.
    """
    state = state._replace(stage="compare", medians=medians)
    if state.spread > timing.WORTHLESS:
        state = state._replace(
            fallback=f"the photographs contradict each other by {state.spread:.2f} stops"
        )
    names = state.bracket.names
    if np.isnan(state.spread):
        return state._replace(doubts=(*state.doubts, say("alone")), fallback=say("alone"))
    said = contradictions.warn_of_contradictions(found, names, state.spread)
    if not said and moved > motion.MOVED:
        said = say("moved", percent=100 * moved)
    if not said and bands > motion.BANDED:
        said = say("flicker", stops=bands)
    if not said and state.spread > CONTRADICTION:
        stops = zip(names, consistency.measure_deviations(medians), strict=True)
        off = ", ".join(f"{name} by {by:+.2f}" for name, by in stops if abs(by) > 0.1)
        said = say("unexplained", stops=state.spread, off=off)
    if said:
        return state._replace(doubts=(*state.doubts, said))
    unknown = [name for name, by in zip(names, found.stops, strict=True) if np.isnan(by)]
    note = f"the times could not be checked by the pixels: {', '.join(unknown)}"
    return state._replace(notes=(*state.notes, note)) if unknown else state
