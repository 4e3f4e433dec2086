"""The photographs brought to lie on each other, by a method of `align` or a function of yours."""

from collections.abc import Callable, Sequence
from functools import cache, partial

import numpy as np

from hdrlab.align.resample import cut, photographs
from hdrlab.align.shift import as_offsets, crop, shift
from hdrlab.core.arrays import F64, Array
from hdrlab.core.bracket import Bracket
from hdrlab.core.filters import warp
from hdrlab.diagnostics.registration import Validation
from hdrlab.pipeline import alignment, recovery
from hdrlab.pipeline.assembly import Assembly, Method

# what to do where photographs do not lie on each other, by the method
ADVICE = {"mtb": 'align by "auto", which rotates them too, or leave one out'}
LEAVE = 'leave one out, or align by "none" if it is the scene that moved'
# of a photograph, which are moved at once
ROWS = 32


def aligned(
    bracket: Bracket, align: Method, response: Method = "auto", in_place: bool = False
) -> Assembly:
    """Return the Assembly after alignment: by a method's name, a function, or "none"; see `moved`."""
    curve = cache(partial(provisional, bracket, response))  # found where it is asked for, and once
    H, pairs, notes = registered(bracket, align, curve)
    g = curve() if H.ndim == 3 else None
    doubts, more = describe(pairs, bracket.names, ADVICE.get(str(align), LEAVE))
    taken, H = moved(bracket, H, g, in_place=in_place), warp.as_homographies(H)
    middle = (np.array(bracket.images.shape[2:0:-1]) - 1) / 2
    offsets = np.rint(warp.apply(H, [middle])[:, 0] - middle).astype(np.int64)[:, ::-1]
    return Assembly("align", taken, offsets, notes=notes + more, doubts=doubts, homographies=H)


def describe(
    pairs: tuple[Validation, ...], names: Sequence[str], advice: str
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return doubts and notes on the pairs of a bracket, one sentence at most in both together.

    A pair of which nothing is known is no reason for a doubt: it stays as it is, and where its
    neighbours stand still this is where it belongs.
    """

    def which(found: list[Validation]) -> str:
        first, more = found[0], len(found) - 1
        and_more = f" (and {more} more pair{'s' * (more > 1)})" if more else ""
        return f"{names[first.moving]} and {names[first.fixed]}{and_more}"

    if apart := [one for one in pairs if one.apart]:
        return (f"{which(apart)} do not lie on each other: {apart[0].failure}; {advice}",), ()
    unknown = [one for one in pairs if not one.known]
    if unknown and any(np.any(one.step != np.eye(3)) for one in pairs):
        return (), (
            f"{which(unknown)}: too dark or too bright to be laid on each other; moved as one",
        )
    return (), ()


def registered(
    bracket: Bracket, align: Method, g: Callable[[], F64 | None]
) -> tuple[Array, tuple[Validation, ...], tuple[str, ...]]:
    """Return offsets (P, 2) or homographies (P, 3, 3), the validation of each pair, and notes."""
    images, times = bracket.images, bracket.times
    if align == "none":
        return np.zeros((len(images), 2), np.int64), (), ()
    if callable(align):
        answer = np.asarray(align(images))
        return (
            (warp.as_homographies if answer.ndim == 3 else as_offsets)(answer, len(images)),
            (),
            (),
        )
    found = alignment.register(images, align, times=times, g=g)
    if found.method in ("none", "mtb"):
        return found.homographies[:, 1::-1, 2].astype(np.int64), found.pairs, ()
    rotated = f'aligned by "{found.method}", since no shift lays the photographs on each other'
    return found.homographies, found.pairs, (rotated,) if align == "auto" else ()


def provisional(bracket: Bracket, response: Method) -> F64 | None:
    """Return a response out of photographs that are not aligned, by histograms [Cerman06 sec. 6], or None.

    A function is asked for its own.
    """
    if not callable(response):
        response = (
            "linear"
            if response == "linear" or (response == "auto" and bracket.linear)
            else "debevec"
        )
    recover = recovery.find_validated_method(response)
    try:
        return np.asarray(recover(bracket.images, bracket.times, valid=bracket.valid), np.float64)
    except ValueError:  # nothing that two photographs see well: alignment can do without
        return None


def moved(bracket: Bracket, H: Array, g: F64 | None = None, *, in_place: bool = False) -> Bracket:
    """Return the bracket with its photographs, and their masks, moved and cut to what all of them show.

    Offsets (P, 2) shift them as they are, `in_place` in the memory of those given, which are lost
    then; homographies resample their light by the response g.
    """
    images, valid = bracket.images, bracket.valid
    if H.ndim == 3:
        images, valid = photographs(images, H, g, valid=valid)
        return bracket._replace(images=images, valid=valid)
    valid = None if valid is None else shift(valid, H)
    return bracket._replace(images=(shift_in_place if in_place else shift)(images, H), valid=valid)


def shift_in_place(images: Array, offsets: Array) -> Array:
    """Return `shift(images, offsets)` in the memory of the images, which are lost."""
    shown = crop(offsets, images.shape[1:3])
    shape = images[:, *shown].shape
    out = images.reshape(-1)[: np.prod(shape)].reshape(shape)
    for one, image, by in zip(out, images, offsets.tolist(), strict=True):
        for y in range(0, len(one), ROWS):  # none goes further than where it came from
            one[y : y + ROWS] = cut(image, by, shown)[y : y + ROWS]
    return out
