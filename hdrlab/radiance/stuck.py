"""Stuck pixels: light that does not grow with the exposure time is no light.

A single pixel whose level hardly differs between the shortest and the longest frame, and that
stands out from all its eight neighbours, takes their median.
"""

from itertools import product

import numpy as np

from hdrlab.core.arrays import F32, F64, Array, Mask
from hdrlab.core.bracket import short_to_long

# rows of a band, which stays in the processor's cache
ROWS = 128
NEIGHBOURS = [(dy, dx) for dy, dx in product((-1, 0, 1), repeat=2) if (dy, dx) != (0, 0)]


def find_stuck(shortest: Array, longest: Array) -> Mask:
    """Return where a single pixel does not follow the exposure: (H, W) bool from two frames (H, W, C).

    Its level differs by less than 1/32 of the range, and it stands out from all its eight
    neighbours by a quarter of the range: above them in the shortest frame (hot), or below them in
    the longest (dead).

    Examples
    --------
    >>> shortest, longest = np.zeros((2, 3, 3, 1), np.uint8)
    >>> shortest[1, 1] = longest[1, 1] = 250  # a hot pixel: bright in the dark, and no brighter in the light
    >>> int(find_stuck(shortest, longest).sum())
    1
    """
    quarter = (np.iinfo(shortest.dtype).max + 1) // 4
    found = np.zeros(shortest.shape[:2], bool)
    for top in range(0, len(found), ROWS):
        a = shortest[top : top + ROWS]
        b = longest[top : top + ROWS]
        still = np.maximum(a, b) - np.minimum(a, b) < quarter // 8
        y, x, c = np.unravel_index(np.flatnonzero(still), still.shape)
        for frame, sign in (
            (shortest, 1),
            (longest, -1),
        ):  # dead pixels are hot ones of the negative
            found[_exceeding(frame, (y + top, x, c), sign, quarter)] = True
    return found


def _exceeding(frame: Array, at: tuple[Array, ...], sign: int, by: int) -> tuple[Array, ...]:
    """Return where (y, x) those of the places (y, x, c) are that exceed all eight neighbours by `by`."""
    y, x, c = at
    for step in NEIGHBOURS:
        difference = frame[y, x, c].astype(int) - frame[(*_neighbour(y, x, step, frame.shape), c)]
        y, x, c = (axis[sign * difference >= by] for axis in (y, x, c))
    return y, x


def _neighbour(
    y: Array, x: Array, step: tuple[int, int], shape: tuple[int, ...]
) -> tuple[Array, Array]:
    """Return the neighbours' coordinates in one direction, reflected at the border."""
    bottom, right = (shape[0] - 1, shape[1] - 1)
    dy, dx = step
    return bottom - abs(bottom - abs(y + dy)), right - abs(right - abs(x + dx))


def neighbours_median(E: Array, mask: Mask) -> Array:
    """Return, for each masked pixel, the median of its eight neighbours (M[, C])."""
    y, x = np.nonzero(mask)
    return np.median([E[_neighbour(y, x, step, E.shape)] for step in NEIGHBOURS], axis=0)


def repair_stuck(E: F32, frames: Array, times: F64, valid: Mask | None) -> Mask:
    """Replace the stuck pixels of a map E (H, W, C) in place by their neighbours' median; return where.

    Within a stop of exposure a pixel may seem stuck, so then none is.
    """
    shortest, longest = ends = short_to_long(frames, times)[[0, -1]]
    if times[longest] < 2 * times[shortest]:
        return np.zeros(E.shape[:2], bool)
    planes = frames.reshape(*frames.shape[:3], -1)
    stuck = find_stuck(planes[shortest], planes[longest])
    if valid is not None:
        stuck &= valid[ends].all(axis=0)
    if stuck.any():
        E[stuck] = neighbours_median(E, stuck)
    return stuck
