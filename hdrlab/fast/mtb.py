"""Median threshold bitmaps, 64 pixels at a time: XOR, AND and counting of machine words [Ward03].

words   a bitmap, packed     (..., H, ceil(W / 64)) uint64; a row's first pixel is the highest bit of its
                             first word, and what follows its last pixel is 0
bits    of one photograph    (2, H, ceil(W / 64)) uint64: bitmap, and exclusion bitmap, 1 where compared
offset  (dy, dx) pixels      down and right

Of photographs above 2^17 pixels the histogram is counted on rows spread evenly: their median is
that of all to a code. Of levels above 2^19 pixels bits are compared on such rows.
"""

from functools import partial
from itertools import pairwise, product
from typing import Self

import numpy as np

from hdrlab.align import mtb as lesson
from hdrlab.core.arrays import Array, ArrayLike, Mask, NDArray, as_stack
from hdrlab.core.threads import map_in_threads
from hdrlab.errors import InputError

Words = NDArray[np.uint64]
Offset = tuple[int, int]
# a smaller level is compared as a whole, a larger one in some of its rows
MAX_COMPARED_PIXELS = 2**18
# an offset is validated in the largest level that is not larger
MAX_OVERVIEW_PIXELS = 2**20
# percentiles are computed from about this many pixels
PERCENTILE_PIXELS = 2**17
# as many pixels as stay in the processor's cache
PIXELS_PER_BAND = 2**18
# an even number
BAND_ROWS = 32


class Photograph:
    """The gray levels of a photograph at every size, full resolution first, and their histograms."""

    def __init__(self, image: Array, *, bits: int = 6, luma: bool = False) -> None:
        self.Y = [_gray(image, luma)]
        while len(self.Y) < bits and min(self.Y[-1].shape) >= lesson.MIN_SIDE_PIXELS:
            self.Y.append(_shrink(self.Y[-1]))
        self.h = [_histogram(Y) for Y in self.Y]
        self.overview = next(
            (j for j, Y in enumerate(self.Y) if Y.size <= MAX_OVERVIEW_PIXELS), len(self.Y) - 1
        )
        self._bits: dict[tuple[int, ...], Words] = {}
        self._thresholds: dict[tuple[float, int], int] = {}

    def threshold(self, q: float, level: int = 0) -> int:
        """Return the threshold of a level."""
        if (q, level) not in self._thresholds:
            self._thresholds[q, level] = int(lesson.threshold(self.h[level], q))
        return self._thresholds[q, level]

    def bits(self, q: float, level: int, dx: int = 0, first: int = 0) -> Words:
        """Return the bits of a level, moved dx pixels to the right; of a large one of some rows alone."""
        key = level, self.threshold(q, level), first, dx
        if key not in self._bits and dx:
            self._bits[key] = _slide(self.bits(q, level, 0, first), dx)
        elif key not in self._bits:
            self._bits[key] = _bitmaps(self.Y[level][first :: _every(self.Y[level])], key[1])
        return self._bits[key]

    def compare(
        self, fixed: Self, offset: Offset, level: int, q: float
    ) -> tuple[Words, Words, int]:
        """Return where bits differ after an offset, where they are compared, and the rows of the upper half.

        What slides in from the side is 0 in the exclusion bitmap too, so nothing beyond the overlap
        counts.
        """
        dy, dx = offset
        H = len(self.Y[level])
        every = _every(self.Y[level])
        top = -(-max(dy, 0) // every)
        rows = len(range(top * every, min(H, H + dy), every))
        start = (top * every - dy) // every
        A = fixed.bits(q, level)[:, top : top + rows]
        B = self.bits(q, level, dx, -dy % every)[:, start : start + rows]
        kept = A[1] & B[1]
        return (A[0] ^ B[0]) & kept, kept, max(-(-(H // 2) // every) - top, 0)

    def error(self, fixed: Self, level: int, q: float, offset: Offset) -> float:
        """Return bits that differ / bits compared."""
        differ, kept, _ = self.compare(fixed, offset, level, q)
        return int(np.bitwise_count(differ).sum()) / max(int(np.bitwise_count(kept).sum()), 1)

    def offset_onto(self, fixed: Self, q: float = 0.5) -> Offset:
        """Return the offset that lays this photograph on another, as `align.mtb.search` finds it."""
        y = 0
        x = 0
        for level in reversed(range(len(self.Y))):
            nine = [(2 * y + dy, 2 * x + dx) for dy, dx in lesson.NINE_OFFSETS]
            y, x = min(nine, key=partial(self.error, fixed, level, q))
        return y, x

    def count_differences(self, fixed: Self, offset: Offset, level: int, q: float = 0.5) -> Array:
        """Return (4, 2), of the quarters of a level: bits that differ after an offset, bits compared.

        The quarters are cut at a whole word.
        """
        differ, kept, n = self.compare(fixed, offset, level, q)
        ones = (np.bitwise_count(differ), np.bitwise_count(kept))
        half = kept.shape[1] // 2
        quarters = product((slice(n), slice(n, None)), (slice(half), slice(half, None)))
        return np.array(
            [[counts[quarter].sum(dtype=np.int64) for counts in ones] for quarter in quarters]
        )


def align(images: ArrayLike, *, bits: int = 6, luma: bool = False) -> NDArray[np.int64]:
    """Return the offsets (P, 2) that lay every image on the one in the middle of their brightness."""
    images = as_stack(images)
    if bits < 1:
        raise InputError(f"expected at least 1 bit for the largest offset, got bits={bits}")
    order = lesson.by_brightness(images)
    taken = map_in_threads(
        lambda image: Photograph(images[image], bits=bits, luma=luma), order, pixels=images[0].size
    )
    found = [
        moving.offset_onto(fixed) for moving, fixed in pairwise(taken)
    ]  # a few at a time in memory
    return lesson.chain_offsets(order, found)


def _gray(image: Array, luma: bool) -> Array:
    Y = np.empty(image.shape[:2], np.uint8)
    for row in range(0, len(Y), BAND_ROWS):
        Z = image[row : row + BAND_ROWS].copy()
        green = Z.ndim == 3 and Z.itemsize == 1 and not luma
        Y[row : row + BAND_ROWS] = Z[..., 1] if green else lesson.gray(Z, luma=luma)
    return Y


def _shrink(Y: Array) -> Array:
    rows = Y.shape[0] // 2 * 2
    columns = Y.shape[1] // 2 * 2
    half = np.empty((rows // 2, columns // 2), np.uint8)
    for row in range(0, rows, BAND_ROWS):
        two = np.ascontiguousarray(Y[row : min(row + BAND_ROWS, rows), :columns]).view(np.uint16)
        two = (two & 255) + (two >> 8)
        half[row // 2 : (row + BAND_ROWS) // 2] = (two[::2] + two[1::2] + 2) >> 2
    return half


def _every(Y: Array) -> int:
    """Return of how many rows one is compared."""
    return -(-Y.size // MAX_COMPARED_PIXELS)


def _histogram(Y: Array) -> NDArray[np.int64]:
    rows = np.linspace(0, len(Y) - 1, min(len(Y), PERCENTILE_PIXELS // Y.shape[1] + 1)).astype(int)
    return np.bincount(Y[rows].ravel(), minlength=256)


def _bitmaps(Y: Array, t: int) -> Words:
    packed = []
    for Z in np.array_split(Y, Y.size // PIXELS_PER_BAND + 1):
        mask = np.empty((2, *Z.shape), bool)
        mask[0] = t < Z
        mask[1] = lesson.exclusion(Z, t)
        packed.append(_pack(mask))
    return np.concatenate(packed, axis=1)


def _pack(mask: Mask) -> Words:
    packed = np.packbits(mask, axis=-1)
    whole = np.zeros((*packed.shape[:-1], -(-packed.shape[-1] // 8) * 8), np.uint8)
    whole[..., : packed.shape[-1]] = packed
    return whole.view(">u8").astype(np.uint64)


def _slide(words: Words, dx: int) -> Words:
    """Return every row moved dx pixels to the right: zeros come in, and what leaves is gone."""
    n = words.shape[-1]
    whole, part = divmod(dx, 64)
    moved = np.zeros_like(words)
    for by, bits in ((whole, part), (whole + 1, part - 64)) if part else ((whole, 0),):
        end = max(n + min(by, 0), 0)
        source = words[..., max(-by, 0) : max(n - by, 0)]
        moved[..., max(by, 0) : end] |= (
            source >> np.uint64(bits) if bits >= 0 else source << np.uint64(-bits)
        )
    return moved
