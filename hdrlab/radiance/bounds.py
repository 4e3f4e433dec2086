"""What the map says of a pixel that no frame measures.

Z      levels of such pixels       (P, M), frames from short to long
B      ln exposure times           (P,)
g      ln f^-1                     (n,), ln exposure of each level
top    the first clipped level     above it a level says only "at least"

A frame that does not measure a pixel still bounds it: clipped in frame j, its radiance is at least
f^-1(top) / t_j; dark (level 0) in frame j, at most f^-1(1) / t_j. The tightest bounds come from the shortest
clipped frame and the longest dark one. With one of them the map takes it, with both it takes the middle of
their logarithms: so a clipped sun is never darker than the sky that was measured beside it.
"""

from enum import IntFlag
from itertools import product

import numpy as np
from numpy.typing import NDArray

from hdrlab.core.arrays import Array

Float = NDArray[np.float64]
ROWS = 32  # a band of rows stays in the processor's cache
RING = [(dy, dx) for dy, dx in product((-1, 0, 1), repeat=2) if (dy, dx) != (0, 0)]


class Seen(IntFlag):
    """How a pixel of the map is known: MEASURED, or what stood in the way."""

    MEASURED = 0
    CLIPPED = 1  # clipped in every frame that shows it: the shortest frame's lower bound
    DARK = 2  # dark in every frame: the longest frame's upper bound; together with CLIPPED: between the two
    STUCK = 4  # does not follow the exposure: its neighbours' median
    UNSEEN = 8  # no frame shows it: 0


def bound(
    Z: Array, B: Float, g: Float, top: int, shown: NDArray[np.bool_]
) -> tuple[Float, NDArray[np.uint8]]:
    """Return E (M,) and flags (M,) of pixels that no frame measures, from the frames' tightest bounds."""
    clipped, dark = shown & (Z >= top), shown & (Z == 0)
    lower = np.where(clipped, g[top] - B[:, None], -np.inf).max(axis=0)
    upper = np.where(dark, g[1] - B[:, None], np.inf).min(axis=0)
    flags = Seen.CLIPPED * np.isfinite(lower) + Seen.DARK * np.isfinite(upper)
    lE = np.where(np.isfinite(upper), upper, lower)
    both = np.isfinite(lower) & np.isfinite(upper)
    lE[both] = (lower[both] + upper[both]) / 2
    return np.where(flags, np.exp(lE), 0.0), np.where(flags, flags, Seen.UNSEEN).astype(np.uint8)


def stuck(shortest: Array, longest: Array) -> NDArray[np.bool_]:
    """Return where a single pixel does not follow the exposure: (H, W) bool from two frames (H, W, C).

    Its level moves by less than 1/32 of the range, and it stands out from all its eight neighbours by a
    quarter of the range: above them in the shortest frame (hot), or below them in the longest (dead).

    Examples
    --------
    >>> shortest, longest = np.zeros((2, 3, 3, 1), np.uint8)
    >>> shortest[1, 1] = longest[1, 1] = 250  # a hot pixel: bright in the dark, and no brighter in the light
    >>> int(stuck(shortest, longest).sum())
    1
    """
    quarter = (np.iinfo(shortest.dtype).max + 1) // 4
    found = np.zeros(shortest.shape[:2], bool)
    for top in range(0, len(found), ROWS):
        a, b = shortest[top : top + ROWS], longest[top : top + ROWS]
        still = np.maximum(a, b) - np.minimum(a, b) < quarter // 8
        y, x, c = np.unravel_index(np.flatnonzero(still), still.shape)
        for frame, sign in ((shortest, 1), (longest, -1)):  # dead pixels are hot ones of the negative
            found[_above_neighbours(frame, (y + top, x, c), sign, quarter)] = True
    return found


def _above_neighbours(frame: Array, at: tuple[Array, ...], sign: int, by: int) -> tuple[Array, ...]:
    """Return where (y, x) those of the places (y, x, c) are that exceed all eight neighbours by that much."""
    y, x, c = at
    for step in RING:
        difference = frame[y, x, c].astype(int) - frame[(*_beside(y, x, step, frame.shape), c)]
        y, x, c = (axis[sign * difference >= by] for axis in (y, x, c))
    return y, x


def _beside(y: Array, x: Array, step: tuple[int, int], shape: tuple[int, ...]) -> tuple[Array, Array]:
    """Return the neighbours' coordinates in one direction, reflected at the border."""
    (bottom, right), (dy, dx) = (shape[0] - 1, shape[1] - 1), step
    return bottom - abs(bottom - abs(y + dy)), right - abs(right - abs(x + dx))


def neighbours_median(E: Array, mask: NDArray[np.bool_]) -> Array:
    """Return, for each masked pixel, the median of its eight neighbours (M[, C])."""
    y, x = np.nonzero(mask)
    return np.median([E[_beside(y, x, step, E.shape)] for step in RING], axis=0)
