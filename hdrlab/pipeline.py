"""Where the chapters meet: a bracket of photographs -> a radiance map -> a picture.

Each stage may be a method's name or a function of the same signature, so a reader's own plugs in wherever the
library's does. `assemble_steps` yields what is known after each stage; `assemble` returns the last of it.
"""

import sys
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.align import judge, mtb, pairs
from hdrlab.align.shift import as_offsets, shift
from hdrlab.core import catalogue, colour, weights
from hdrlab.core.bracket import Bracket
from hdrlab.core.steps import last
from hdrlab.radiance import consistency
from hdrlab.radiance import times as timing
from hdrlab.radiance.contradictions import contradictions, doubt
from hdrlab.radiance.merge import METHODS, merge_seen

Method = str | Callable[..., Any]
Table = NDArray[np.float64]
STAGES = ("align", "response", "merge", "compare")
WEIGHTS: dict[str, Callable[[Table], Table]] = {  # by name, from the response
    "hat": lambda g: weights.hat(len(g)),
    "gaussian": lambda g: weights.gaussian(len(g)),
    "flat": lambda g: weights.flat(len(g)),
    "snr": weights.snr,
}
CONTRADICTION = 0.25  # stops of spread; brackets with true times stay below 0.2, scanned film included
REGISTER = "no shift lays one on the other; leave one out, or bring them to lie on each other by other means"


class Assembly(NamedTuple):
    """What is known of a bracket after a stage; what is not known yet is None.

    Attributes
    ----------
    stage : the one of STAGES that was done last, or "times", after "align" where these are estimated
    bracket : the photographs, moved and cut to what all of them show
    offsets : (P, 2) int, (dy, dx) pixels, where each photograph was moved
    g : (n,) or (n, 3), response, ln exposure of each level
    E : (h, w) or (h, w, 3) float32, radiance
    seen : (h, w) uint8, how each pixel is known: flags of `radiance.bounds.Seen`
    medians : (P, C, 256), what each frame says of each level: see `radiance.consistency`
    notes : sentences, what to know about this map
    doubts : sentences, reasons not to trust it
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
) -> Iterator[Assembly]:
    """Yield the Assembly after each of STAGES; the parameters are those of `assemble`."""
    _check_exposures(bracket)
    if weight not in WEIGHTS:
        raise ValueError(f"expected a weight out of {', '.join(WEIGHTS)}, got {weight!r}")
    if method not in METHODS:
        raise ValueError(f"expected a method out of {', '.join(METHODS)}, got {method!r}")
    if times not in ("stated", "estimate"):
        raise ValueError(f"expected times out of stated, estimate, got {times!r}")
    state = aligned(bracket, align)
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
    yield compared(state, consistency.level_medians(images, seconds, E, valid=valid))


def _check_exposures(bracket: Bracket) -> None:
    """Raise a ValueError where a bracket holds fewer than two exposures."""
    if len(set(bracket.times.tolist())) < 2:
        exposures = zip(bracket.names, bracket.times, strict=True)
        got = ", ".join(f"{name} {time:.6g} s" for name, time in exposures)
        raise ValueError(f"expected photographs of at least two different exposures, got {got}")


def aligned(bracket: Bracket, align: Method) -> Assembly:
    """Return the Assembly after alignment: by a method's name, a function, or "none"."""
    offsets = np.zeros((len(bracket.images), 2), np.int64)
    verdicts: tuple[pairs.Verdict, ...] = ()
    if align == "mtb":
        verdicts = mtb.verdicts(bracket.images)
        offsets = pairs.along(verdicts)
    elif align != "none":
        offsets = as_offsets(catalogue.method("align", align)(bracket.images), len(bracket.images))
    lost = [one for one in verdicts if one.informative and one.confidence < judge.DOUBT]
    notes = tuple(_about(one, bracket) for one in verdicts if one.trouble and one not in lost)
    doubts = tuple(f"{_about(one, bracket)}: {REGISTER}" for one in lost)
    return Assembly("align", moved(bracket, offsets), offsets, notes=notes, doubts=doubts)


def moved(bracket: Bracket, offsets: NDArray[np.int64]) -> Bracket:
    """Return the bracket with its photographs, and their masks, moved and cut to what all of them show."""
    valid = bracket.valid
    if valid is not None:
        valid = shift(valid.view(np.uint8), offsets).view(bool)
    return bracket._replace(images=shift(bracket.images, offsets), valid=valid)


def _about(verdict: pairs.Verdict, bracket: Bracket) -> str:
    """Return the sentence on a pair that is in trouble."""
    moving, fixed = bracket.names[verdict.moving], bracket.names[verdict.fixed]
    return f"{moving} against {fixed}, moved by {verdict.offset} pixels: {verdict.trouble}"


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
        A method of `align`, "none", or your own `align(images) -> offsets (P, 2)`.
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
