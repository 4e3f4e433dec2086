"""Median threshold bitmaps, 64 pixels at a time: XOR, AND and counting of machine words [Ward03].

words   a bitmap, packed     (..., H, ceil(W / 64)) uint64; a row's first pixel is the highest bit of its
                             first word, and what follows its last pixel is 0
bits    of one photograph    (2, H, ceil(W / 64)) uint64: bitmap, and exclusion bitmap, 1 where compared
offset  (dy, dx) pixels      down and right

Of photographs above 2^17 pixels the histogram is counted on rows spread evenly: their median is that of all
to a code.
"""

from itertools import pairwise
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.align import mtb as lesson
from hdrlab.core.arrays import as_stack
from hdrlab.core.types import Array, Mask

Words = NDArray[np.uint64]
Offset = tuple[int, int]
# pixels: the percentiles of this many are those of all
ENOUGH = 2**17
# pixels of a band of rows that fits the processor's cache
CACHE = 2**18
# rows of a band of which every third byte is picked
BAND = 32


class Photograph:
    """The gray levels of a photograph at every size, full resolution first, and their histograms."""

    def __init__(self, image: Array, *, bits: int = 6, luma: bool = False) -> None:
        self.Y = [_gray(image, luma)]
        while len(self.Y) < bits and min(self.Y[-1].shape) >= lesson.SMALLEST:
            self.Y.append(_shrink(self.Y[-1]))
        self.h = [_histogram(Y) for Y in self.Y]
        self._bits: dict[tuple[int, int], Words] = {}

    def threshold(self, q: float, level: int = 0) -> int:
        """Return the threshold of a level."""
        return int(lesson.threshold(self.h[level], q))

    def bits(self, q: float, level: int) -> Words:
        """Return the bits of a level, which is compared with the one before and the one after."""
        key = level, self.threshold(q, level)
        if key not in self._bits:
            self._bits[key] = _bitmaps(self.Y[level], key[1])
        return self._bits[key]

    def offset_onto(self, fixed: Self, q: float = 0.5) -> Offset:
        """Return the offset that lays this photograph on another, as `align.mtb.search` finds it."""
        y, x = 0, 0
        for level in reversed(range(len(self.Y))):
            errors = _errors(fixed.bits(q, level), self.bits(q, level), (2 * y, 2 * x))
            dy, dx = min(lesson.NINE, key=lambda d: errors[d[0] + 1, d[1] + 1])
            y, x = 2 * y + dy, 2 * x + dx
        return y, x

    def count_differences(
        self, fixed: Self, offset: Offset, every: int = 1, q: float = 0.5
    ) -> NDArray[np.int64]:
        """Return (4, 2), of the quarters of the picture: bits that differ after an offset, bits compared.

        Of every n-th row; the quarters are cut at a whole word.
        """
        dy, H = offset[0], len(self.Y[0])
        rows = np.arange(-(-max(dy, 0) // every) * every, max(H + min(dy, 0), 0), every)
        A, B = fixed.bits(q, 0)[:, rows], _slide(self.bits(q, 0)[:, rows - dy], offset[1])
        kept = A[1] & B[1]
        counts = np.bitwise_count(np.stack([(A[0] ^ B[0]) & kept, kept]))
        n, half = np.searchsorted(rows, H // 2), kept.shape[1] // 2
        quarters = [
            rest for part in (counts[:, :n], counts[:, n:]) for rest in np.split(part, [half], axis=2)
        ]
        return np.array([one.sum(axis=(1, 2), dtype=np.int64) for one in quarters])


def align(images: ArrayLike, *, bits: int = 6, luma: bool = False) -> NDArray[np.int64]:
    """Return the offsets (P, 2) that lay every image on the one in the middle of their brightness."""
    images = as_stack(images)
    if bits < 1:
        raise ValueError(f"expected at least 1 bit for the largest offset, got bits={bits}")
    order = lesson.by_brightness(images)
    taken = (Photograph(images[image], bits=bits, luma=luma) for image in order)
    found = [moving.offset_onto(fixed) for moving, fixed in pairwise(taken)]  # two at a time in memory
    return lesson.chain_offsets(order, found)


def _gray(image: Array, luma: bool) -> Array:
    Y = np.empty(image.shape[:2], np.uint8)
    for row in range(0, len(Y), BAND):
        Z = image[row : row + BAND].copy()
        green = Z.ndim == 3 and Z.itemsize == 1 and not luma
        Y[row : row + BAND] = Z[..., 1] if green else lesson.gray(Z, luma=luma)
    return Y


def _shrink(Y: Array) -> Array:
    rows, columns = Y.shape[0] // 2 * 2, Y.shape[1] // 2 * 2
    pairs = np.add(Y[0:rows:2, :columns], Y[1:rows:2, :columns], dtype=np.uint16)
    return ((pairs[:, 0::2] + pairs[:, 1::2] + 2) >> 2).astype(np.uint8)


def _histogram(Y: Array) -> NDArray[np.int64]:
    rows = np.linspace(0, len(Y) - 1, min(len(Y), ENOUGH // Y.shape[1] + 1)).astype(int)
    return np.bincount(Y[rows].ravel(), minlength=256)


def _bitmaps(Y: Array, t: int) -> Words:
    bands = np.array_split(Y, Y.size // CACHE + 1)
    return np.concatenate([_pack(np.stack([t < Z, lesson.exclusion(Z, t)])) for Z in bands], axis=1)


def _pack(mask: Mask) -> Words:
    packed = np.packbits(mask, axis=-1)
    whole = np.zeros((*packed.shape[:-1], -(-packed.shape[-1] // 8) * 8), np.uint8)
    whole[..., : packed.shape[-1]] = packed
    return whole.view(">u8").astype(np.uint64)


def _slide(words: Words, dx: int) -> Words:
    """Return every row moved dx pixels to the right: zeros come in, and what leaves is gone."""
    whole, part = divmod(dx, 64)
    n, margin = words.shape[-1], abs(whole) + 1
    wide = np.zeros((*words.shape[:-1], n + 2 * margin), np.uint64)
    wide[..., margin : margin + n] = words
    first = margin - whole
    moved = wide[..., first : first + n] >> np.uint64(part)
    if part:
        moved |= wide[..., first - 1 : first - 1 + n] << np.uint64(64 - part)
    return moved


def _errors(fixed: Words, moving: Words, offset: Offset) -> NDArray[np.float64]:
    """Return the errors (3, 3) of the nine offsets around one, rows dy and columns dx.

    What slides in from the side is 0 in the exclusion bitmap too, so nothing beyond the overlap is compared.
    """
    errors, H = np.zeros((3, 3)), fixed.shape[1]
    for j in range(3):
        moved = _slide(moving, offset[1] + j - 1)
        for i in range(3):
            dy = offset[0] + i - 1
            A, A_kept = fixed[:, max(dy, 0) : max(H + dy, 0)]
            B, B_kept = moved[:, max(-dy, 0) : max(H - dy, 0)]
            kept = A_kept & B_kept
            compared = int(np.bitwise_count(kept).sum())
            errors[i, j] = int(np.bitwise_count((A ^ B) & kept).sum()) / max(compared, 1)
    return errors
