"""Comparing bitmaps: XOR for the difference, AND with the exclusions, and counting bits, 64 pixels at a time.

mask    a bitmap             (..., H, W) bool
words   the same, packed     (..., H, ceil(W / 64)) uint64; a row's first pixel is the highest bit of
                             its first word, and what follows its last pixel is 0
bits    of one photograph    (2, H, ceil(W / 64)) uint64: bitmap, and exclusion bitmap, 1 where compared
found   a disagreement       (..., 2) int64: how many bits differ, and how many are compared
offset  (dy, dx)             pixels, down and right
"""

import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.bool_]
Words = NDArray[np.uint64]
Counts = NDArray[np.int64]
Offset = tuple[int, int]


def pack(mask: Mask) -> Words:
    """Return the words of a mask."""
    packed = np.packbits(mask, axis=-1)
    whole = np.zeros((*packed.shape[:-1], -(-packed.shape[-1] // 8) * 8), np.uint8)
    whole[..., : packed.shape[-1]] = packed
    return whole.view(">u8").astype(np.uint64)


def unpack(words: Words, width: int) -> Mask:
    """Return the mask of words whose rows hold `width` pixels."""
    return np.unpackbits(words.astype(">u8").view(np.uint8), axis=-1, count=width).view(np.bool_)


def slide(words: Words, dx: int) -> Words:
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


def count(words: Words) -> int:
    """Return how many bits are 1."""
    return int(np.bitwise_count(words).sum())


def overlap(fixed: Words, moving: Words, dy: int) -> tuple[Words, Words]:
    """Return the rows that two photographs share once `moving` has gone dy pixels down."""
    shared = max(fixed.shape[-2] - abs(dy), 0)
    top, source = max(dy, 0), max(-dy, 0)
    return fixed[:, top : top + shared], moving[:, source : source + shared]


def disagreement(fixed: Words, moved: Words) -> Counts:
    """Return how many bits differ and how many are compared: XOR, AND with both exclusions, bit count.

    Examples
    --------
    >>> everywhere = pack(np.ones((1, 4), bool))
    >>> fixed, moved = (np.stack([pack(mask), everywhere]) for mask in ([[1, 1, 0, 0]], [[1, 0, 0, 0]]))
    >>> disagreement(fixed, moved).tolist()  # of 4 pixels one differs
    [1, 4]
    """
    compared = fixed[1] & moved[1]
    return np.array([count((fixed[0] ^ moved[0]) & compared), count(compared)])


def around(fixed: Words, moving: Words, offset: Offset, *, stride: int = 1, every: int = 1) -> Counts:
    """Return the disagreement (3, 3, 2) at the nine offsets a stride around `offset`: rows dy, columns dx.

    What slides in from the side is 0 in the exclusion bitmap too, so nothing beyond the overlap is compared.
    With `every` above 1 only one row in so many is.
    """
    found = np.empty((3, 3, 2), np.int64)
    for j in range(3):
        moved = slide(moving, offset[1] + (j - 1) * stride)
        for i in range(3):
            a, b = overlap(fixed, moved, offset[0] + (i - 1) * stride)
            found[i, j] = disagreement(a[:, ::every], b[:, ::every])
    return found


def error(found: Counts) -> NDArray[np.float64]:
    """Return the bits that differ / the bits compared; 0 where none is."""
    return np.asarray(found[..., 0] / np.maximum(found[..., 1], 1))
