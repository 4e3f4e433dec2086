"""The photographs brought to lie on each other, by a method of `align` or a function of yours."""

import numpy as np

from hdrlab.align.resample import photographs
from hdrlab.align.shift import as_offsets, shift
from hdrlab.core import warp
from hdrlab.core.bracket import Bracket
from hdrlab.core.types import F64, Array
from hdrlab.diagnostics.registration import LOST, Validation
from hdrlab.pipeline import alignment
from hdrlab.pipeline.assembly import Assembly, Method
from hdrlab.pipeline.recovery import find_validated_method

# these compare light, so they need times and a response
BY_LIGHT = ("auto", *alignment.SEARCHES)
# what to do where photographs do not lie on each other, by whether they were rotated, too
ADVICE = {
    False: 'no shift clearly lays one on the other; align by "auto", which turns them too, or leave one out',
    True: "no homography clearly lays one on the other; leave one out",
}


def aligned(bracket: Bracket, align: Method, response: Method = "auto") -> Assembly:
    """Return the Assembly after alignment: by a method's name, a function, or "none"."""
    by_light = align in BY_LIGHT
    g = provisional(bracket, response) if by_light else None
    H, pairs, notes = registered(bracket, align, g)
    if H.ndim == 3 and not by_light:
        g = provisional(bracket, response)
    lost = [one for one in pairs if one.informative and one.confidence < LOST]
    notes += tuple(_about(one, bracket) for one in pairs if one.failure and one not in lost)
    doubts = tuple(f"{_about(one, bracket)}: {ADVICE[by_light]}" for one in lost)
    taken, H = moved(bracket, H, g), warp.as_homographies(H)
    middle = (np.array(bracket.images.shape[2:0:-1]) - 1) / 2
    offsets = np.rint(warp.apply(H, [middle])[:, 0] - middle).astype(np.int64)[:, ::-1]
    return Assembly("align", taken, offsets, notes=notes, doubts=doubts, homographies=H)


def registered(
    bracket: Bracket, align: Method, g: F64 | None
) -> tuple[Array, tuple[Validation, ...], tuple[str, ...]]:
    """Return offsets (P, 2) or homographies (P, 3, 3), the validation of each pair, and notes."""
    images, times = bracket.images, bracket.times
    if align == "none":
        return np.zeros((len(images), 2), np.int64), (), ()
    if callable(align):
        answer = np.asarray(align(images))
        return (warp.as_homographies if answer.ndim == 3 else as_offsets)(answer, len(images)), (), ()
    found = alignment.register(images, align, times=times, g=g)
    if align == "mtb":
        return found.homographies[:, 1::-1, 2].astype(np.int64), found.pairs, ()
    if align != "auto":
        return found.homographies, found.pairs, ()
    off, still = (100 * np.sqrt(found.errors[one]) for one in (found.method, "none"))
    said = f'aligned by "{found.method}": light that differs by {off:.1f} %, and by {still:.1f} % as it was'
    return found.homographies, found.pairs, (said,)


def provisional(bracket: Bracket, response: Method) -> F64 | None:
    """Return a response out of photographs that are not aligned, by histograms [Cerman06 sec. 6], or None.

    A function is asked for its own.
    """
    if not callable(response):
        response = "linear" if response == "linear" or (response == "auto" and bracket.linear) else "debevec"
    recover = find_validated_method(response)
    try:
        return np.asarray(recover(bracket.images, bracket.times, valid=bracket.valid), np.float64)
    except ValueError:  # nothing that two photographs see well: alignment can do without
        return None


def moved(bracket: Bracket, H: Array, g: F64 | None = None) -> Bracket:
    """Return the bracket with its photographs, and their masks, moved and cut to what all of them show.

    Offsets (P, 2) shift them as they are; homographies resample their light by the response g.
    """
    images, valid = bracket.images, bracket.valid
    if H.ndim == 3:
        images, valid = photographs(images, H, g, valid=valid)
        return bracket._replace(images=images, valid=valid)
    if valid is not None:
        valid = shift(valid.view(np.uint8), H).view(bool)
    return bracket._replace(images=shift(images, H), valid=valid)


def _about(pair: Validation, bracket: Bracket) -> str:
    """Return the sentence on a pair whose alignment is not to be trusted."""
    moving, fixed = bracket.names[pair.moving], bracket.names[pair.fixed]
    by = "({:.3g}, {:.3g}) pixels".format(*pair.offset)
    by += f" and rotated by {pair.degrees:.2f} degrees" if pair.degrees else ""
    return f"{moving} against {fixed}, moved by {by}: {pair.failure}"
