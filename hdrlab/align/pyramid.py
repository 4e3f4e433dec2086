"""A photograph at every size: gray, half of it, a quarter ..., and how often each code occurs.

Y  gray photograph    (H, W) uint8: codes 0 ... 255, whatever depth the photograph has
h  histogram of Y     (256,) int64, counts
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hdrlab.core.arrays import Array

Gray = NDArray[np.uint8]
Histogram = NDArray[np.int64]

SMALLEST = 16  # pixels: a level with a side below this is not halved again
ENOUGH = 2**17  # pixels: the percentiles of so many are those of all
BAND = 32  # rows


class Frame(NamedTuple):
    """What image `image` of a stack brings: Y and h of every level, full resolution first."""

    image: int
    Y: list[Gray]
    h: list[Histogram]


def codes(Z: Array, *, luma: bool = False) -> Gray:
    """Return Y = (54 R + 183 G + 19 B) / 256, or green alone, which is faster [the slide allows either]."""
    Z = Z if Z.ndim == 2 or luma else Z[..., 1]
    if Z.dtype == np.uint16:
        Z = (Z >> 8).astype(np.uint8)  # so that one code is the same share of the range
    if Z.ndim == 3:
        R, G, B = (Z[..., channel].astype(np.uint16) for channel in range(3))
        Z = ((54 * R + 183 * G + 19 * B) >> 8).astype(np.uint8)
    return Z


def gray(image: Array, *, luma: bool = False) -> Gray:
    """Return `codes` of the image, made in bands of rows: every third byte is picked faster in the cache."""
    Y = np.empty(image.shape[:2], np.uint8)
    for row in range(0, len(Y), BAND):
        Y[row : row + BAND] = codes(image[row : row + BAND].copy(), luma=luma)
    return Y


def shrink(Y: Gray) -> Gray:
    """Return Y at half the size: the mean of each 2 x 2 pixels, rounded.

    Examples
    --------
    >>> shrink(np.array([[0, 10, 4, 4], [20, 30, 4, 4]], np.uint8)).tolist()
    [[15, 4]]
    """
    rows, columns = Y.shape[0] // 2 * 2, Y.shape[1] // 2 * 2
    pairs = np.add(Y[0:rows:2, :columns], Y[1:rows:2, :columns], dtype=np.uint16)
    return ((pairs[:, 0::2] + pairs[:, 1::2] + 2) >> 2).astype(np.uint8)


def histogram(Y: Gray) -> Histogram:
    """Return h, counted on rows spread evenly where there are more pixels than its percentiles need."""
    rows = np.linspace(0, len(Y) - 1, min(len(Y), ENOUGH // Y.shape[1] + 1)).astype(int)
    return np.bincount(Y[rows].ravel(), minlength=256)


def frame(images: Array, image: int, *, bits: int, luma: bool) -> Frame:
    """Return the Frame of one image: a level for each bit of the largest offset, 2^bits - 1."""
    Y = [gray(images[image], luma=luma)]
    while len(Y) < bits and min(Y[-1].shape) >= SMALLEST:
        Y.append(shrink(Y[-1]))
    return Frame(image, Y, [histogram(level) for level in Y])
