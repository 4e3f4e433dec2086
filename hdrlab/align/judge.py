"""Whether to trust the offset that a search brought back.

Of Ward's brackets 84 % came out well; the others had turned, moved too far, or were all fine texture. A
search answers all the same, so its answer is looked at once more, at full resolution: is it better than not
moving, better than the offsets around it, and do the four quarters of the picture agree? In a rotation
each of them moves another way. And does the picture repeat itself, so that another offset fits as well?

error   bits that differ / bits compared
near    (4, 3, 3, 2) disagreement of the quarters, 2 pixels around the offset
far     (3, 3, 2) disagreement of the whole, 8 pixels around the offset
"""

import numpy as np
from numpy.typing import NDArray
from scipy.fft import fftshift, irfft2, rfft2
from scipy.ndimage import maximum_filter

from hdrlab.align.bitmaps import Counts, Offset, Words, around, disagreement, error, overlap, slide, unpack
from hdrlab.align.pairs import Verdict, blind

TILE = 96  # pixels: in so large a part of the picture, its middle, repeating textures are looked for
RIVALS = 4  # shifts, at which a texture resembles itself most
ALIKE = 0.1  # of the way up to the error elsewhere: a rival this low fits as well
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


def rivals(fixed: Words) -> list[Offset]:
    """Return the shifts at which a picture's middle resembles itself most: peaks of its autocorrelation."""
    rows = slice(max(fixed.shape[1] - TILE, 0) // 2, max(fixed.shape[1] - TILE, 0) // 2 + TILE)
    first = max(fixed.shape[2] - TILE // 64, 0) // 2
    columns = slice(first, first + -(-TILE // 64))
    bits, kept = (unpack(words, 64 * words.shape[-1]) for words in fixed[:, rows, columns])
    x = np.where(kept, np.where(bits, 1.0, -1.0), 0)
    x = np.where(kept, x - x.sum() / max(kept.sum(), 1), 0)
    c = irfft2(np.abs(rfft2(x, (2 * x.shape[0], 2 * x.shape[1]))) ** 2)
    c = fftshift(c)[:, c.shape[1] // 2 :]  # it is the same about its middle
    y, x_ = np.nonzero((c == maximum_filter(c, 5)) & (c > 0))
    best = np.argsort(-c[y, x_], kind="stable")[: RIVALS + 1]
    shifts = [(int(y[j]) - c.shape[0] // 2, int(x_[j])) for j in best]
    return [shift for shift in shifts if max(map(abs, shift)) > NEAR]


def repeated(fixed: Words, moved: Words, after: Counts, far: Counts) -> str:
    """Return by how much the picture may be moved on and still fit, in words, or nothing."""
    here, elsewhere = float(error(after)), float(np.mean(error(far)))
    for dy, dx in rivals(fixed):
        also = float(error(disagreement(fixed, move(moved, (dy, dx)))))
        if also - here < ALIKE * (elsewhere - here):
            return f"the picture repeats itself: moved on by {(dy, dx)} it fits as well"
    return ""


def trouble(offset: Offset, near: Counts, far: Counts, limit: int) -> str:
    """Return why the offset in the middle of `near` and `far` is not to be trusted, or nothing."""
    here, others = near[:, 1, 1], np.delete(near.reshape(-1, 9, 2), 4, axis=1)
    if max(map(abs, offset)) >= limit:
        return f"the offset lies at the end of the range, {limit} pixels"
    if not far[..., 0].any():
        return f"the picture repeats itself: {FAR} pixels away the photographs fit as well"
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
    parts = zip(quarters(fixed), quarters(moved), strict=True)
    near = np.array([around(a, b, (0, 0), stride=NEAR, every=ROWS) for a, b in parts])
    if not far[..., 0].any() and not near[..., 0].any():  # wherever one looks, all bits are the same
        return blind(*pair)
    errors = float(error(before)), float(error(after))
    said = trouble(offset, near, far, limit) or repeated(fixed, moved, after, far)
    return Verdict(*pair, offset, *errors, confidence(far), True, said)
