"""Whether to trust the offset that a search brought back.

Of Ward's brackets 84 % came out well; the others had turned, moved too far, or were all fine texture. A
search answers all the same, so its answer is looked at once more, at full resolution: is it better than not
moving, better than the offsets around it, and do the four quarters of the picture agree? In a rotation
each of them moves another way.

error   bits that differ / bits compared
near    (4, 3, 3, 2) disagreement of the quarters, 2 pixels around the offset
far     (3, 3, 2) disagreement of the whole, 8 pixels around the offset
"""

import numpy as np
from numpy.typing import NDArray

from hdrlab.align.bitmaps import Counts, Offset, Words, around, disagreement, error, overlap, slide
from hdrlab.align.pairs import Verdict, blind

NEAR, FAR = 2, 8  # pixels: how far around the offset to look
ROWS = 4  # a quarter of the rows tells enough
DOUBT = 0.3  # confidence; photographs that do not fit stay below 0.1, and those that do come to 0.6 and more


def clearly_less(found: Counts, other: Counts) -> NDArray[np.bool_]:
    """Whether an error is below another by a twentieth of it and three standard deviations of its count."""
    rate = error(other)
    return np.asarray(rate - error(found) > rate / 20 + 3 * np.sqrt(rate / np.maximum(other[..., 1], 1)))


def move(bits: Words, offset: Offset) -> Words:
    """Return the bits moved by an offset; what comes in from outside is excluded."""
    moved = np.zeros_like(bits)
    rows, source = overlap(moved, slide(bits, offset[1]), offset[0])
    rows[:] = source
    return moved


def quarters(bits: Words) -> list[Words]:
    """Return the four quarters of a picture, its columns cut at a whole word."""
    return [
        quarter for half in np.array_split(bits, 2, axis=1) for quarter in np.array_split(half, 2, axis=2)
    ]


def confidence(far: Counts) -> float:
    """Return 1 - error / the mean error 8 pixels around: 1 is a perfect match, 0 no better than elsewhere.

    Examples
    --------
    >>> found = np.full((3, 3, 2), [40, 100])
    >>> found[1, 1] = [4, 100]
    >>> confidence(found)
    0.9
    """
    errors = error(far)
    elsewhere = (errors.sum() - errors[1, 1]) / 8
    return float(1 - errors[1, 1] / elsewhere) if elsewhere > 0 else 0.0


def trouble(offset: Offset, near: Counts, far: Counts, limit: int) -> str:
    """Return why the offset in the middle of `near` and `far` is not to be trusted, or nothing."""
    here, others = near[:, 1, 1], np.delete(near.reshape(-1, 9, 2), 4, axis=1)
    if max(map(abs, offset)) >= limit:
        return f"the offset lies at the end of the range, {limit} pixels"
    if confidence(far) < DOUBT:
        return f"8 pixels away the photographs fit nearly as well (confidence {confidence(far):.2f})"
    if not np.all(clearly_less(here.sum(0), others.sum(0))):
        return "2 pixels away the photographs fit as well"
    away = np.count_nonzero(clearly_less(others, here[:, None]).any(axis=1))
    if away:
        return f"{away} of 4 quarters of the picture fit better elsewhere (rotation, or a scene that moves)"
    return ""


def judge(pair: tuple[int, int], fixed: Words, moving: Words, offset: Offset, *, limit: int) -> Verdict:
    """Return the Verdict on a pair (moving, fixed) whose search, up to `limit` pixels, found `offset`.

    Its offset is (0, 0) where the one found is not clearly better than that.
    """
    moved = move(moving, offset)
    before, after = disagreement(fixed, moving), disagreement(fixed, moved)
    if not clearly_less(after, before):
        offset, moved, after = (0, 0), moving, before
    far = around(fixed, moved, (0, 0), stride=FAR, every=ROWS)
    if not far[..., 0].any():
        return blind(*pair)
    parts = zip(quarters(fixed), quarters(moved), strict=True)
    near = np.array([around(a, b, (0, 0), stride=NEAR, every=ROWS) for a, b in parts])
    errors = float(error(before)), float(error(after))
    return Verdict(*pair, offset, *errors, confidence(far), True, trouble(offset, near, far, limit))
