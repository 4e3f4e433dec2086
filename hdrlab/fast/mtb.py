"""Median threshold bitmaps, 64 pixels at a time: XOR, AND and counting of machine words [Ward03].

words   a packed bitmap    (..., H, ceil(W / 64)) uint64; the first pixel of a row is the highest bit
                           of its first word, and the bits after its last pixel are 0
bits    of one photograph  (2, H, ceil(W / 64)) uint64: bitmap, and exclusion bitmap (1 = compared)
offset  (dy, dx) pixels    down and right

Photos of more than 2^17 pixels count their histogram on evenly spaced rows: their median is that of
all rows to one pixel value. Levels of more than 2^18 pixels compare bits on such rows.
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
    """The gray levels of a photograph at every size, full resolution first, with histograms."""

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
        """Return the bits of a level, moved dx pixels to the right; cached.

        A large level has bits of some rows only: `first`, and then one in `_row_step`.
        """
        threshold = self.threshold(q, level)
        key = level, threshold, first, dx
        if key not in self._bits:
            if dx:
                self._bits[key] = _shift_right(self.bits(q, level, 0, first), dx)
            else:
                Y = self.Y[level]
                self._bits[key] = _bitmaps(Y[first :: _row_step(Y)], threshold)
        return self._bits[key]

    def compare(
        self, fixed: Self, offset: Offset, level: int, q: float
    ) -> tuple[Words, Words, int]:
        """Return the differing bits after an offset, the compared bits, and the rows of the upper half.

        Bits that come in from the side are 0 in the exclusion bitmap, too, so only the overlap
        counts.
        """
        dy, dx = offset
        H = len(self.Y[level])
        step = _row_step(self.Y[level])
        top = -(-max(dy, 0) // step)
        row_count = len(range(top * step, min(H, H + dy), step))
        start = (top * step - dy) // step
        fixed_bitmap, fixed_exclusion = fixed.bits(q, level)[:, top : top + row_count]
        bitmap, exclusion = self.bits(q, level, dx, -dy % step)[:, start : start + row_count]
        compared = fixed_exclusion & exclusion
        differing = (fixed_bitmap ^ bitmap) & compared
        upper_rows = max(-(-(H // 2) // step) - top, 0)
        return differing, compared, upper_rows

    def error(self, fixed: Self, level: int, q: float, offset: Offset) -> float:
        """Return the fraction of the compared bits that differ."""
        differing, compared, _ = self.compare(fixed, offset, level, q)
        differing_count = int(np.bitwise_count(differing).sum())
        compared_count = int(np.bitwise_count(compared).sum())
        return differing_count / max(compared_count, 1)

    def offset_onto(self, fixed: Self, q: float = 0.5) -> Offset:
        """Return the offset that aligns this photo with another, as `align.mtb.search` finds it."""
        y = 0
        x = 0
        for level in reversed(range(len(self.Y))):
            nine = [(2 * y + dy, 2 * x + dx) for dy, dx in lesson.NINE_OFFSETS]
            y, x = min(nine, key=partial(self.error, fixed, level, q))
        return y, x

    def count_differences(self, fixed: Self, offset: Offset, level: int, q: float = 0.5) -> Array:
        """Return (4, 2): for each quarter of a level, the bits that differ, and the bits compared.

        The quarters are cut at a whole word.
        """
        differing, compared, n = self.compare(fixed, offset, level, q)
        differing_counts = np.bitwise_count(differing)
        compared_counts = np.bitwise_count(compared)
        half = compared.shape[1] // 2
        quarters = product((slice(n), slice(n, None)), (slice(half), slice(half, None)))
        sums = [
            (
                differing_counts[quarter].sum(dtype=np.int64),
                compared_counts[quarter].sum(dtype=np.int64),
            )
            for quarter in quarters
        ]
        return np.array(sums)


def align(images: ArrayLike, *, bits: int = 6, luma: bool = False) -> NDArray[np.int64]:
    """Return the offsets (P, 2) that align every image with the one of middle brightness."""
    images = as_stack(images)
    if bits < 1:
        raise InputError(f"expected at least 1 bit for the largest offset, got bits={bits}")
    order = lesson.by_brightness(images)

    def make_photograph(j: int) -> Photograph:
        return Photograph(images[j], bits=bits, luma=luma)

    # an iterator, so that only a few photographs are in memory at a time
    photographs = map_in_threads(make_photograph, order, pixels=images[0].size)
    offsets = [moving.offset_onto(fixed) for moving, fixed in pairwise(photographs)]
    return lesson.chain_offsets(order, offsets)


def _gray(image: Array, luma: bool) -> Array:
    """Return the gray levels (H, W) of an image: green, or luma, see `align.mtb.gray`."""
    Y = np.empty(image.shape[:2], np.uint8)
    for row in range(0, len(Y), BAND_ROWS):
        Z = image[row : row + BAND_ROWS].copy()
        is_green = Z.ndim == 3 and Z.itemsize == 1 and not luma
        Y[row : row + BAND_ROWS] = Z[..., 1] if is_green else lesson.gray(Z, luma=luma)
    return Y


def _shrink(Y: Array) -> Array:
    """Return the rounded means of 2 x 2 gray levels."""
    rows = Y.shape[0] // 2 * 2
    columns = Y.shape[1] // 2 * 2
    half = np.empty((rows // 2, columns // 2), np.uint8)
    for row in range(0, rows, BAND_ROWS):
        band = np.ascontiguousarray(Y[row : min(row + BAND_ROWS, rows), :columns])
        # two neighbours of 8 bits are one number of 16 bits
        pairs = band.view(np.uint16)
        sums = (pairs & 255) + (pairs >> 8)
        half[row // 2 : (row + BAND_ROWS) // 2] = (sums[::2] + sums[1::2] + 2) >> 2
    return half


def _row_step(Y: Array) -> int:
    """Return the step between the rows that are compared."""
    return -(-Y.size // MAX_COMPARED_PIXELS)


def _histogram(Y: Array) -> NDArray[np.int64]:
    """Return the histogram of evenly spaced rows."""
    row_count = min(len(Y), PERCENTILE_PIXELS // Y.shape[1] + 1)
    rows = np.linspace(0, len(Y) - 1, row_count).astype(int)
    return np.bincount(Y[rows].ravel(), minlength=256)


def _bitmaps(Y: Array, t: int) -> Words:
    """Return the packed bitmap and exclusion bitmap of gray levels at a threshold."""
    packed = []
    for Z in np.array_split(Y, Y.size // PIXELS_PER_BAND + 1):
        mask = np.empty((2, *Z.shape), bool)
        mask[0] = t < Z
        mask[1] = lesson.exclusion(Z, t)
        packed.append(_pack(mask))
    return np.concatenate(packed, axis=1)


def _pack(mask: Mask) -> Words:
    """Return a mask packed into words of 64 pixels, filled up with 0."""
    packed = np.packbits(mask, axis=-1)
    byte_count = packed.shape[-1]
    padded = np.zeros((*packed.shape[:-1], -(-byte_count // 8) * 8), np.uint8)
    padded[..., :byte_count] = packed
    return padded.view(">u8").astype(np.uint64)


def _shift_right(words: Words, dx: int) -> Words:
    """Return every row moved dx pixels to the right, or to the left for dx < 0; zeros come in."""
    whole_words, bits = divmod(dx, 64)
    moved = np.zeros_like(words)
    target, source = _overlap(words.shape[-1], whole_words)
    moved[..., target] = words[..., source] >> np.uint64(bits)
    if bits:
        target, source = _overlap(words.shape[-1], whole_words + 1)
        moved[..., target] |= words[..., source] << np.uint64(64 - bits)
    return moved


def _overlap(n: int, offset: int) -> tuple[slice, slice]:
    """Return which of n places a move by `offset` fills, and the places that they come from."""
    target = slice(max(offset, 0), max(n + min(offset, 0), 0))
    source = slice(max(-offset, 0), max(n - offset, 0))
    return target, source
