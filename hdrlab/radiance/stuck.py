"""Stuck pixels: their level does not follow the exposure time.

A single pixel is stuck if its level hardly differs between the shortest and the longest frame, and
differs much from all its eight neighbours. It is replaced by their median.
"""

from itertools import product

import numpy as np

from hdrlab.core.arrays import F32, F64, Array, Mask
from hdrlab.core.bracket import short_to_long

# as many rows as stay in the processor's cache
BAND_ROWS = 128
# (dy, dx) of the eight neighbours
NEIGHBOURS = [(dy, dx) for dy, dx in product((-1, 0, 1), repeat=2) if (dy, dx) != (0, 0)]


def find_stuck(shortest: Array, longest: Array) -> Mask:
    """Return the single pixels that do not follow the exposure, (H, W) bool, from two frames (H, W, C).

    The level of such a pixel differs by less than 1/32 of the range between the frames. And it is
    above all its eight neighbours in the shortest frame by a quarter of the range (stuck at white),
    or below them in the longest frame (dead).

    Examples
    --------
    >>> shortest, longest = np.zeros((2, 3, 3, 1), np.uint8)
    >>> shortest[1, 1] = longest[1, 1] = 250  # stuck: bright in the dark, and no brighter in the light
    >>> int(find_stuck(shortest, longest).sum())
    1
    """
    quarter = (np.iinfo(shortest.dtype).max + 1) // 4
    stuck = np.zeros(shortest.shape[:2], bool)
    for top in range(0, len(stuck), BAND_ROWS):
        a = shortest[top : top + BAND_ROWS]
        b = longest[top : top + BAND_ROWS]
        still = np.maximum(a, b) - np.minimum(a, b) < quarter // 8
        y, x, c = np.unravel_index(np.flatnonzero(still), still.shape)
        hot = _exceeding(shortest, (y + top, x, c), sign=1, threshold=quarter)
        dead = _exceeding(longest, (y + top, x, c), sign=-1, threshold=quarter)
        stuck[hot] = True
        stuck[dead] = True
    return stuck


def _exceeding(
    frame: Array, places: tuple[Array, ...], *, sign: int, threshold: int
) -> tuple[Array, Array]:
    """Return those of the places (y, x, c), as (y, x), that differ from all eight neighbours.

    They are above them by the threshold if the sign is 1, and below them if it is -1.
    """
    y, x, c = places
    for step in NEIGHBOURS:
        ny, nx = _neighbour(y, x, step, frame.shape)
        difference = frame[y, x, c].astype(int) - frame[ny, nx, c]
        kept = sign * difference >= threshold
        y = y[kept]
        x = x[kept]
        c = c[kept]
    return y, x


def _neighbour(
    y: Array, x: Array, step: tuple[int, int], shape: tuple[int, ...]
) -> tuple[Array, Array]:
    """Return the neighbours' coordinates in one direction, reflected at the border."""
    bottom = shape[0] - 1
    right = shape[1] - 1
    dy, dx = step
    return bottom - abs(bottom - abs(y + dy)), right - abs(right - abs(x + dx))


def neighbours_median(E: Array, mask: Mask) -> Array:
    """Return, for each masked pixel, the median of its eight neighbours (M[, C])."""
    y, x = np.nonzero(mask)
    return np.median([E[_neighbour(y, x, step, E.shape)] for step in NEIGHBOURS], axis=0)


def repair_stuck(E: F32, frames: Array, times: F64, valid: Mask | None) -> Mask:
    """Replace stuck pixels of a map E (H, W, C) in place by their neighbours' median; return their mask.

    If the exposures span less than a stop, stuck pixels cannot be told from others, and none is
    replaced.
    """
    ends = short_to_long(frames, times)[[0, -1]]
    shortest, longest = ends
    if times[longest] < 2 * times[shortest]:
        return np.zeros(E.shape[:2], bool)
    planes = frames.reshape(*frames.shape[:3], -1)
    stuck = find_stuck(planes[shortest], planes[longest])
    if valid is not None:
        stuck &= valid[ends].all(axis=0)
    if stuck.any():
        E[stuck] = neighbours_median(E, stuck)
    return stuck
