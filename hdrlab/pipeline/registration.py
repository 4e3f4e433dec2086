"""The photographs brought to lie on each other, by a method of `align` or a function of yours."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hdrlab.align import auto, cerman, homography, judge, matches, mtb, pairs
from hdrlab.align.resample import photographs
from hdrlab.align.shift import as_offsets, shift
from hdrlab.core import warp
from hdrlab.core.bracket import Bracket
from hdrlab.pipeline import catalogue
from hdrlab.pipeline.assembly import Assembly, Method
from hdrlab.pipeline.recovery import validated

Found = pairs.Verdict | matches.Match
BY_LIGHT = {"auto": auto, "cerman": cerman, "homography": homography}  # these want times and a response
REGISTER = {  # what to do where photographs do not lie on each other, by whether they were turned, too
    False: 'no shift clearly lays one on the other; align by "auto", which turns them too, or leave one out',
    True: "no move clearly lays one on the other; leave one out",
}


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
    recover = validated(response)
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
