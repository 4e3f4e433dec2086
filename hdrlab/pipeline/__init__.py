"""Where the chapters meet: a bracket of photographs -> a radiance map -> a picture.

Each stage may be a method's name or a function of the same signature, so a reader's own plugs in wherever the
library's does. `assemble_steps` yields what is known after each stage; `assemble` returns the last of it.
"""

import sys
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.align import auto, cerman, homography, judge, matches, mtb, pairs
from hdrlab.align.resample import photographs
from hdrlab.align.shift import as_offsets, shift
from hdrlab.core import catalogue, colour, warp, weights
from hdrlab.core.bracket import Bracket
from hdrlab.core.steps import last
from hdrlab.radiance import consistency
from hdrlab.radiance import flare as glare
from hdrlab.radiance import ghosts as moving
from hdrlab.radiance import times as timing
from hdrlab.radiance.contradictions import contradictions, doubt
from hdrlab.radiance.merge import METHODS, Merged, merge_seen

Method = str | Callable[..., Any]
Table = NDArray[np.float64]
Found = pairs.Verdict | matches.Match
STAGES = ("align", "response", "merge", "compare")
GHOSTS = ("none", "regions", "reference")
FLARE = ("none", "veil")
WEIGHTS: dict[str, Callable[[Table], Table]] = {  # by name, from the response
    "hat": lambda g: weights.hat(len(g)),
    "gaussian": lambda g: weights.gaussian(len(g)),
    "flat": lambda g: weights.flat(len(g)),
    "snr": weights.snr,
}
CONTRADICTION = 0.25  # stops of spread; brackets with true times stay below 0.2, scanned film included
BY_LIGHT = {"auto": auto, "cerman": cerman, "homography": homography}  # these want times and a response
REGISTER = {  # what to do where photographs do not lie on each other, by whether they were turned, too
    False: 'no shift clearly lays one on the other; align by "auto", which turns them too, or leave one out',
    True: "no move clearly lays one on the other; leave one out",
}


class Assembly(NamedTuple):
    """What is known of a bracket after a stage; what is not known yet is None.

    Attributes
    ----------
    stage : the one of STAGES that was done last, or "times", after "align" where these are estimated, or
        "ghosts" or "flare", after "merge" where these are taken off
    bracket : the photographs, moved and cut to what all of them show
    offsets : (P, 2) int, (dy, dx) pixels, where each photograph, or its middle, was moved
    g : (n,) or (n, 3), response, ln exposure of each level
    E : (h, w) or (h, w, 3) float32, radiance
    seen : (h, w) uint8, how each pixel is known: flags of `radiance.bounds.Seen`
    medians : (P, C, 256), what each frame says of each level: see `radiance.consistency`
    notes : sentences, what to know about this map
    doubts : sentences, reasons not to trust it
    moves : (P, 3, 3), where each photograph was moved, rotation, scale and fractions of pixels included
    moving : (h, w) int32, the regions in which something moved, 0 elsewhere; None where nobody asked
    veiled : (h, w) bool, where a veil was taken off; None where nobody asked
    """

    stage: str
    bracket: Bracket
    offsets: NDArray[np.int64]
    g: NDArray[np.float64] = None  # type: ignore[assignment]  # typed as what each stage makes of it
    E: NDArray[np.float32] = None  # type: ignore[assignment]
    seen: NDArray[np.uint8] = None  # type: ignore[assignment]
    medians: NDArray[np.float64] = None  # type: ignore[assignment]
    notes: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()
    moves: NDArray[np.float64] = None  # type: ignore[assignment]
    moving: NDArray[np.int32] | None = None
    veiled: NDArray[np.bool_] | None = None

    @property
    def spread(self) -> float:
        """How far the frames contradict each other, in stops; NaN before the last stage."""
        return consistency.spread(self.medians) if self.medians is not None else float("nan")


def assemble_steps(
    bracket: Bracket,
    *,
    align: Method = "mtb",
    response: Method = "auto",
    weight: str = "gaussian",
    method: str = "log",
    times: str = "stated",
    ghosts: str = "none",
    flare: str = "none",
) -> Iterator[Assembly]:
    """Yield the Assembly after each of STAGES; the parameters are those of `assemble`."""
    _check_exposures(bracket)
    if weight not in WEIGHTS:
        raise ValueError(f"expected a weight out of {', '.join(WEIGHTS)}, got {weight!r}")
    if method not in METHODS:
        raise ValueError(f"expected a method out of {', '.join(METHODS)}, got {method!r}")
    if times not in ("stated", "estimate"):
        raise ValueError(f"expected times out of stated, estimate, got {times!r}")
    if ghosts not in GHOSTS or flare not in FLARE:
        ways = f"ghosts out of {', '.join(GHOSTS)} and flare out of {', '.join(FLARE)}"
        raise ValueError(f"expected {ways}, got {ghosts!r} and {flare!r}")
    state = aligned(bracket, align, response)
    yield state
    if response == "auto":
        response = "linear" if bracket.linear else "debevec"
    w = WEIGHTS[weight]
    if times == "estimate":
        yield (state := retimed(state, response, w, method))
    images, seconds, _, valid, _ = state.bracket
    g = catalogue.method("response", response)(images, seconds, valid=valid)
    yield (state := state._replace(stage="response", g=g))
    E, seen = merge_seen(images, seconds, g, w(g), method=method, valid=valid)
    yield (state := state._replace(stage="merge", E=E, seen=seen))
    if ghosts != "none":
        yield (state := unghosted(state, ghosts, w, method))
    if flare != "none":
        yield (state := unveiled(state))
    yield compared(state, consistency.level_medians(images, seconds, E, valid=valid))


def unghosted(state: Assembly, way: str, w: Callable[[Table], Table], method: str) -> Assembly:
    """Return the Assembly without the ghosts of what moved; the reference is the middle photograph."""
    images, times, names, valid, _ = state.bracket
    found = moving.remove(
        images,
        times,
        state.g,
        w(state.g),
        merged=Merged(state.E, state.seen),
        reference=len(images) // 2 if way == "reference" else None,
        method=method,
        valid=valid,
    )
    notes = (*state.notes, moving.note(found, names))
    return state._replace(stage="ghosts", E=found.E, seen=found.seen, moving=found.labels, notes=notes)


def unveiled(state: Assembly) -> Assembly:
    """Return the Assembly without the light that the lens scattered."""
    found = glare.remove(state.E)
    return state._replace(
        stage="flare", E=found.E, veiled=found.region, notes=(*state.notes, glare.note(found))
    )


def _check_exposures(bracket: Bracket) -> None:
    """Raise a ValueError where a bracket holds fewer than two exposures."""
    if len(set(bracket.times.tolist())) < 2:
        exposures = zip(bracket.names, bracket.times, strict=True)
        got = ", ".join(f"{name} {time:.6g} s" for name, time in exposures)
        raise ValueError(f"expected photographs of at least two different exposures, got {got}")


def aligned(bracket: Bracket, align: Method, response: Method = "auto") -> Assembly:
    """Return the Assembly after alignment: by a method's name, a function, or "none"."""
    by_light = align in BY_LIGHT
    g = provisional(bracket, response) if by_light else None
    moves, found, notes = registered(bracket, align, g)
    if moves.ndim == 3 and not by_light:
        g = provisional(bracket, response)
    lost = [one for one in found if one.informative and one.confidence < judge.DOUBT]
    notes += tuple(_about(one, bracket) for one in found if one.trouble and one not in lost)
    doubts = tuple(f"{_about(one, bracket)}: {REGISTER[by_light]}" for one in lost)
    H, middle = warp.as_moves(moves), (np.array(bracket.images.shape[2:0:-1]) - 1) / 2
    offsets = np.rint(warp.apply(H, [middle])[:, 0] - middle).astype(np.int64)[:, ::-1]
    return Assembly("align", moved(bracket, moves, g), offsets, notes=notes, doubts=doubts, moves=H)


def registered(
    bracket: Bracket, align: Method, g: NDArray[np.float64] | None
) -> tuple[NDArray[Any], tuple[Found, ...], tuple[str, ...]]:
    """Return offsets (P, 2) or moves (P, 3, 3), what was found of each pair, and what to know of it."""
    images, times = bracket.images, bracket.times
    if align == "none":
        return np.zeros((len(images), 2), np.int64), (), ()
    if align == "mtb":
        shifts = mtb.verdicts(images)
        return pairs.along(shifts), shifts, ()
    if align == "auto":
        way, errors, turned = auto.choose(images, times=times, g=g)
        off, still = (100 * np.sqrt(errors[one]) for one in (way, "none"))
        said = f'aligned by "{way}": light that differs by {off:.1f} %, and by {still:.1f} % if left as it is'
        return matches.along(turned), turned, (said,)
    if align in BY_LIGHT:
        turned = BY_LIGHT[str(align)].verdicts(images, times=times, g=g)
        return matches.along(turned), turned, ()
    answer = np.asarray(catalogue.method("align", align)(images))
    check = warp.as_moves if answer.ndim == 3 else as_offsets
    return check(answer, len(images)), (), ()


def provisional(bracket: Bracket, response: Method) -> NDArray[np.float64] | None:
    """Return a response out of photographs that are not aligned, by histograms [Cerman06 sec. 6], or None.

    A function is asked for its own.
    """
    if not callable(response):
        response = "linear" if response == "linear" or (response == "auto" and bracket.linear) else "debevec"
    recover = catalogue.method("response", response)
    try:
        return np.asarray(recover(bracket.images, bracket.times, valid=bracket.valid), np.float64)
    except ValueError:  # nothing that two photographs see well: alignment can do without
        return None


def moved(bracket: Bracket, moves: NDArray[Any], g: NDArray[np.float64] | None = None) -> Bracket:
    """Return the bracket with its photographs, and their masks, moved and cut to what all of them show.

    Offsets shift them as they are; moves resample their light, as g tells it.
    """
    images, valid = bracket.images, bracket.valid
    if moves.ndim == 3:
        images, valid = photographs(images, moves, g, valid=valid)
        return bracket._replace(images=images, valid=valid)
    if valid is not None:
        valid = shift(valid.view(np.uint8), moves).view(bool)
    return bracket._replace(images=shift(images, moves), valid=valid)


def _about(found: Found, bracket: Bracket) -> str:
    """Return the sentence on a pair that is in trouble."""
    moving, fixed = bracket.names[found.moving], bracket.names[found.fixed]
    if isinstance(found, pairs.Verdict):
        return f"{moving} against {fixed}, moved by {found.offset} pixels: {found.trouble}"
    dy, dx = found.offset
    by = f"({dy:.1f}, {dx:.1f}) pixels and turned by {found.degrees:.2f} degrees"
    return f"{moving} against {fixed}, moved by {by}: {found.trouble}"


def retimed(state: Assembly, response: Method, w: Callable[[Table], Table], method: str) -> Assembly:
    """Return the Assembly with times from the pixels, where these prove it, and a note on what was found."""
    images, stated, names, valid, _ = state.bracket
    recover = catalogue.method("response", response)

    def spread(times: NDArray[np.float64]) -> float:
        g = recover(images, times, valid=valid)
        E = merge_seen(images, times, g, w(g), method=method, valid=valid).E
        return consistency.spread(consistency.level_medians(images, times, E, valid=valid))

    known = recover(images, stated, valid=valid) if response == "linear" else None
    found = timing.estimate(images, stated, spread, g=known, valid=valid)
    bracket = state.bracket._replace(times=found.times)
    notes, doubts = (*state.notes, timing.note(found, names)), (*state.doubts, *timing.doubts(found))
    return state._replace(stage="times", bracket=bracket, notes=notes, doubts=doubts)


def compared(state: Assembly, medians: NDArray[np.float64]) -> Assembly:
    """Return the Assembly with what its frames say of each level, and what that puts in doubt."""
    state = state._replace(stage="compare", medians=medians)
    images, times, names, valid, _ = state.bracket
    alone = "no level stands in two frames, so the times cannot be compared with the pixels"
    if np.isnan(state.spread):
        return state._replace(notes=(*state.notes, alone))
    said = doubt(contradictions(images, times, valid=valid), names)
    if not said and state.spread > CONTRADICTION:
        stops = zip(names, consistency.deviations(medians), strict=True)
        off = ", ".join(f"{name} by {by:+.2f}" for name, by in stops if abs(by) > 0.1)
        said = (
            f"the photographs contradict their exposure times by {state.spread:.2f} stops ({off}): "
            "check the times, and that the camera did not change ISO, aperture or its processing"
        )
    return state._replace(doubts=(*state.doubts, said)) if said else state


def assemble(bracket: Bracket, **knobs: Any) -> Assembly:
    """Return the radiance map of a bracket, with all that was found on the way.

    Parameters
    ----------
    bracket : Bracket
        At least two photographs of different exposure.
    align : str or function
        A method of `align`, "none", or your own `align(images)` -> offsets (P, 2) of whole pixels or moves
        (P, 3, 3). "mtb" shifts by whole pixels and leaves every pixel as it is. "cerman" turns too and
        "homography" takes scale and tilt; both compare light, and resample it, by a provisional response
        out of the histograms. "auto" takes whichever lays the photographs on each other best, see
        `align.auto`.
    response : str or function
        A method of `response`, "auto" (linear where the bracket is, else Debevec), or your own
        `recover(images, times, *, valid) -> g`.
    weight : {"gaussian", "hat", "flat", "snr"}
        How far the merge trusts a level. Under the Gaussian, which all but ignores the ends, the frames of
        real brackets contradict each other least.
    method : {"log", "likelihood", "mean", "shot"}
        How the frames are merged, see `radiance.merge`.
    times : {"stated", "estimate"}
        "estimate" corrects rough times by the pixels, where that makes the frames agree better: see
        `radiance.times`.

    ghosts : {"none", "regions", "reference"}
        What becomes of what moved: it stays half transparent; in each region its best exposure leads, or the
        middle photograph in all of them: see `radiance.ghosts`.
    flare : {"none", "veil"}
        Whether light that the lens scattered is taken off, where the map shows it: see `radiance.flare`.

    Returns
    -------
    Assembly
        Read its `doubts` before you trust its `E`.

    Raises
    ------
    ValueError
        For brackets that hold fewer than two exposures or nothing that two of them see well, and for
        names that no method has.

    Examples
    --------
    >>> from hdrlab.capture import camera, scenes
    >>> photographs = camera.shoot(scenes.room((96, 144)), [0.01, 0.04, 0.16, 0.64], rng=1)
    >>> assembly = assemble(photographs)
    >>> assembly.E.shape, assembly.doubts
    ((96, 144, 3), ())
    """
    return last(assemble_steps(bracket, **knobs))


def develop(
    E: ArrayLike,
    tonemap: Method = "reinhard",
    *,
    saturation: float | None = None,
    way: str = "ratio",
    **knobs: Any,
) -> NDArray[np.uint8]:
    """Return the picture of a radiance map: tone-mapped luminance, its colours, sRGB in 8 bits.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance, any linear unit.
    tonemap : str or function
        A method of `tonemap`, or your own `tonemap(L, **knobs) -> Ld` in [0, 1].
    saturation : float, optional
        1 keeps the ratios of the channels, 0 is gray; the SATURATION of the operator's module, or else 1.
    way : {"ratio", "chroma"}
        How colour comes back, and what becomes of colours beyond the display: "ratio" clips a channel,
        "chroma" keeps hue and luminance and gives up saturation, see `core.colour`.
    **knobs
        Those of the operator.

    Returns
    -------
    (H, W) or (H, W, 3) uint8

    Raises
    ------
    ValueError
        For radiance that is not finite or negative, and for knobs out of their range.
    """
    operator = catalogue.method("tonemap", tonemap)
    saturation = own_saturation(operator) if saturation is None else saturation
    L = colour.luminance(E)
    return colour.render(E, L, operator(L, **knobs), saturation=saturation, way=way)


def own_saturation(operator: Callable[..., Any]) -> float:
    """Return the SATURATION that the module of an operator states, or 1."""
    return float(getattr(sys.modules[operator.__module__], "SATURATION", 1.0))
