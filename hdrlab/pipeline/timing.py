"""Exposure times by the pixels: stated ones corrected, and relative ones for photographs that come with none.

The histograms of two photographs of one scene give their exposure ratio, if the response is known.
Taken is that of a usual camera: its JPEGs are steeper than the curve of sRGB, in three by a power
of 1.3 to 1.5. So these times are true up to a power, and `diagnostics.exposure_times` then improves
each of them.
"""

from itertools import pairwise

import numpy as np

from hdrlab.align import light, mtb
from hdrlab.core import arrays, colour
from hdrlab.core.bracket import Bracket, bracket as make_bracket
from hdrlab.diagnostics import exposure_times, plausibility
from hdrlab.diagnostics.doubts import say
from hdrlab.diagnostics.exposure_times import Estimate
from hdrlab.errors import InputError
from hdrlab.pipeline import recovery
from hdrlab.pipeline.assembly import Assembly, Method, take_frames

# stops by sRGB's curve over stops of exposure
STEEPNESS = 1.4
# stops: less between the darkest and the brightest photograph is one exposure
LEAST_SPAN = 0.3
# stops of spread in held-out pixels: what true times show, and a map that shows what no photograph
# does
TRUE, WORTHLESS = 0.01, 0.5
# pixels of a frame, on an even grid
PIXELS = 400_000


def usual_response(n: int, linear: bool = False) -> arrays.F64:
    """Return ln exposure of n levels for a usual camera, or a linear one; level 0 has a quarter level's."""
    z = np.maximum(np.arange(n), 0.25) / (n - 1)
    return np.log(z) if linear else np.log(colour.decode_srgb(z)) / STEEPNESS


def space_by_stops(bracket: Bracket, stops: arrays.ArrayLike) -> Bracket:
    """Return the bracket with relative times: from dark to bright, each so many stops above the last.

    Parameters
    ----------
    bracket : Bracket, whose times do not count
    stops : one number, or one a step

    Examples
    --------
    >>> space_by_stops(make_bracket(np.uint8([[[90]], [[9]]]), [1, 1]), 2).times.tolist()
    [1.0, 4.0]
    """
    images, _, names, valid, linear = bracket
    if not np.all(np.asarray(stops) >= 0):
        raise InputError(f"expected positive steps between the photographs in stops, got {stops!r}")
    times, steps = (
        np.empty(len(images)),
        np.broadcast_to(np.asarray(stops, float), (len(images) - 1,)),
    )
    times[mtb.by_brightness(images)] = 2 ** np.cumsum([0, *steps])
    return make_bracket(images, times, names, valid=valid, linear=linear)


def estimate_relative_times(bracket: Bracket) -> Bracket:
    """Return the bracket with the times that histograms give under a usual response, the shortest being 1."""
    images = bracket.images if bracket.images.ndim == 3 else bracket.images[..., 1]
    every = max(1, int(np.sqrt(images[0].size / PIXELS)))
    Z, g = images[:, ::every, ::every], usual_response(arrays.levels(images), bracket.linear)
    pairs = pairwise(mtb.by_brightness(bracket.images))
    k = [light.exposure_ratio(Z[dark], Z[bright], g) for dark, bright in pairs]
    return space_by_stops(bracket, np.maximum(np.log2(k), 0))


def complete_times(bracket: Bracket, times: str) -> tuple[Bracket, tuple[str, ...]]:
    """Return the bracket with times that mean something, and a note where they are relative.

    Raises
    ------
    ValueError
        For photographs of one exposure, for times that fall while the photographs get brighter,
        unless they are to be estimated, and for times that are all the same, if "stated".
    """
    images, seconds, names, valid, _ = bracket
    equal, falls = np.ptp(seconds) == 0, np.zeros(0, np.intp)
    if not equal:
        Z = plausibility.ranks(images, valid)
        darker = plausibility.neighbour_errors(Z, seconds, np.zeros((256, Z.shape[-1])))[1]
        falls = np.flatnonzero(darker > 0.5)
        if not len(falls):
            return bracket, ()
    if len(falls) and times != "estimate":
        pair = " and ".join(f"{names[j]} ({seconds[j]:.4g} s)" for j in (falls[0], falls[0] + 1))
        raise InputError(say("order", pair=pair))
    found = estimate_relative_times(bracket)
    if len(seconds) < 2 or np.log2(found.times[-1]) < LEAST_SPAN or (equal and times == "stated"):
        got = ", ".join(f"{name} {time:.6g} s" for name, time in zip(names, seconds, strict=True))
        raise InputError(f"expected photographs of at least two different exposures, got {got}")
    same = "all stated times are the same, so: " if equal and times == "correct" else ""
    return found, (same + describe_steps(found.times),)


def describe_steps(times: arrays.F64) -> str:
    """Return the sentence on relative times: how they were found, and how far to trust them."""
    return say("relative", steps=", ".join(f"{step:.1f}" for step in np.diff(np.log2(times))))


def refine_times(state: Assembly, response: Method, before: float) -> Assembly:
    """Return the Assembly with times by the pixels, where these prove it, and a note on what was found.

    `before` is the spread that its times leave in held-out pixels. Where that is of a map worth
    nothing, and corrections do not help, relative times take their place, with a doubt.
    """
    found, spread = correct_times(state.bracket, response, before)
    doubts = exposure_times.doubts(found)
    if spread > WORTHLESS:
        rising = take_frames(state, np.array(mtb.by_brightness(state.bracket.images)))
        relative = estimate_relative_times(state.bracket).times
        other, spread = correct_times(rising.bracket._replace(times=relative), response, None)
        if spread < WORTHLESS / 2:
            off = f"the stated times contradict the pixels by {before:.2f} stops, so they were not used"
            off = off.replace("by inf stops", "beyond measure")
            state, found, doubts = rising, other, (f"{off}, but {describe_steps(relative)}",)
    notes = (*state.notes, exposure_times.note(found, state.bracket.names))
    state = state._replace(
        bracket=state.bracket._replace(times=found.times),
        notes=notes,
        doubts=(*state.doubts, *doubts),
    )
    return take_frames(state, np.argsort(found.times, kind="stable"))


def correct_times(
    bracket: Bracket, response: Method, before: float | None
) -> tuple[Estimate, float]:
    """Return the Estimate of an aligned bracket's times, and the spread that its times leave."""

    def measure(times: arrays.F64) -> float:
        return recovery.choose_response(response, bracket._replace(times=times)).spread

    images, times, _, valid, linear = bracket
    known = response == "linear" or (response == "auto" and linear)
    g = recovery.find_method("linear")(images, times) if known else None
    found = exposure_times.estimate_times(images, times, measure, g=g, valid=valid)
    if found.accepted:
        return found, found.spread_after
    return found, measure(times) if before is None else before
