"""The radiance map: a weighted mean of what the frames say of each pixel.

Z   pixel levels       (P, H, W[, 3]), n = 256 or 65536 of them
t   exposure times     (P,) seconds; B = ln t
g   ln f^-1            (n,) or (n, 3), ln exposure of each level
w   weights            (n,), how far to trust a level
E   radiance           (H, W[, 3]) float32, exposure per second: 1 brings a pixel to level n / 2 in one second

Every estimate is a quotient of two sums over the frames, sum_j a_j(Z_j) / sum_j b_j(Z_j), whose terms are
tables over the levels: `estimates` has the formulas, `blocks` the sums.

Weight and validity are two things. A weight says how much a level counts; validity says whether the pixel is
a measurement at all. Level 0 is not, nor is a level above the cut; and a frame in which one channel of a
pixel is clipped is left out for all three, lest the highlights take a tint, as long as another frame measures
the pixel. What the map says where no frame does is in `bounds`.
"""

import os
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core import weights
from hdrlab.core.arrays import Array, as_mask, as_stack, as_times, levels
from hdrlab.core.bracket import short_to_long
from hdrlab.radiance import blocks
from hdrlab.radiance.bounds import Seen, neighbours_median, stuck
from hdrlab.radiance.estimates import METHODS

ROWS = 16  # of a block: its planes and sums stay in the processor's cache


class Merged(NamedTuple):
    """The radiance map (H, W[, 3]) and how each of its pixels is known (H, W), flags of `bounds.Seen`."""

    E: NDArray[np.float32]
    seen: NDArray[np.uint8]


def merge(
    images: ArrayLike, times: ArrayLike, g: ArrayLike, w: ArrayLike | None = None, **knobs: Any
) -> Array:
    """Return the radiance map E alone; `merge_seen` has the parameters, and says how each pixel is known."""
    return merge_seen(images, times, g, w, **knobs).E


def merge_seen(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    w: ArrayLike | None = None,
    *,
    method: str = "log",
    top: float = 0.98,
    mend: bool = True,
    valid: ArrayLike | None = None,
    threads: int | None = None,
) -> Merged:
    """Return the radiance map of a bracket, and how each of its pixels is known.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Aligned photographs, in any order.
    times : (P,) float
        Exposure times in seconds.
    g : (n,) or (n, 3) float
        Response, ln exposure of each level; read between its levels where n is not the images'.
    w : (n,) float, optional
        Weights, the hat by default.
    method : {"log", "likelihood", "mean", "shot"}
        Which quotient of sums, a key of `METHODS`.
    top : float
        Levels above this fraction of the top level are clipped.
    mend : bool
        Replace single pixels that do not follow the exposure by their neighbours' median.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.
    threads : int, optional
        How many blocks to merge at once; the number of processors by default.

    Returns
    -------
    Merged
        E (H, W) or (H, W, 3) float32, finite and not negative, and seen (H, W) uint8.

    Raises
    ------
    ValueError
        For arrays that do not fit together, or an unknown method.

    References
    ----------
    Debevec and Malik, SIGGRAPH 1997, sec. 2.2; Robertson, Borman and Stevenson, Journal of Electronic Imaging
    2003, eq. 8.

    Examples
    --------
    >>> images = np.array([[[40, 90]], [[80, 180]]], np.uint8)  # a linear camera, one and two seconds
    >>> E = merge(images, [1, 2], np.log(np.maximum(np.arange(256), 0.5) / 128))
    >>> bool(np.allclose(E, [[40 / 128, 90 / 128]]))
    True
    """
    stack = as_stack(images)
    times, mask = as_times(times, len(stack)), as_mask(valid, stack)
    if method not in METHODS:
        raise ValueError(f"expected a method out of {', '.join(METHODS)}, got {method!r}")
    order = short_to_long(stack, times)
    pixels, n = stack.reshape(*stack.shape[:3], -1), levels(stack)
    w = weights.hat(n) if w is None else w
    plan = blocks.plan(times[order], g, w, METHODS[method], n=n, channels=pixels.shape[-1], top=top)
    E, seen = np.empty(pixels.shape[1:], np.float32), np.empty(pixels.shape[1:3], np.uint8)

    def merge_rows(start: int) -> None:
        rows = slice(start, start + ROWS)
        shown = None if mask is None else np.stack([mask[j, rows] for j in order])
        blocks.merge_block([pixels[j, rows] for j in order], shown, plan, E[rows], seen[rows])

    _each(range(0, len(seen), ROWS), merge_rows, threads or os.cpu_count() or 1)
    ends = order[[0, -1]]
    if mend and times[ends[1]] >= 2 * times[ends[0]]:  # within a stop a pixel may seem to stand still
        odd = stuck(*(pixels[j] for j in ends)) & (mask is None or mask[ends].all(axis=0))
        if odd.any():
            E[odd], seen[odd] = neighbours_median(E, odd), Seen.STUCK
    return Merged(E.reshape(stack.shape[1:]), seen)


def _each(starts: range, work: Callable[[int], None], threads: int) -> None:
    """Do the work of each block, several at a time."""
    if threads == 1:  # a thread of its own would have a memory pool of its own, which is slower
        deque(map(work, starts), maxlen=0)
        return
    with ThreadPoolExecutor(threads) as pool:
        deque(pool.map(work, starts), maxlen=0)
