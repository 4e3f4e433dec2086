"""Which pixels enter a calibration: a stack of photographs -> Z.

images  (P, H, W[, 3]) uint8 or uint16
valid   (P, H, W) bool, False where a photograph holds no picture; None: all is picture
N       number of samples
Z       (N, P[, 3]) intp, 0 ... 255: sample i as frame j shows it; 16 bits are rounded to these 256 levels

Debevec and Malik picked pixels by hand: well distributed in level, from even regions. Both ways here do it
without hands. `by_grid` follows single pixels through the frames, so the frames must be aligned. `by_rank`
matches equal ranks of the frames' histograms [Grossberg03]: brightness is monotone in exposure, so the k-th
darkest pixel of one frame is the k-th darkest of every other. It needs no alignment, averages noise away, and
spends its samples where the pictures have pixels.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import Array, as_mask, as_stack, to_256

Samples = NDArray[np.intp]
PIXELS = 1_000_000  # an even choice of about so many ranks a frame as well as all of it


def by_rank(images: ArrayLike, count: int, *, valid: ArrayLike | None = None) -> Samples:
    """Return Z (N, P[, 3]): the level at rank (i + 1/2) / N of each frame's histogram, channel by channel.

    Examples
    --------
    >>> by_rank(np.arange(8, dtype=np.uint8).reshape(1, 2, 4), 4).ravel().tolist()
    [1, 3, 5, 7]
    """
    stack = as_stack(images)
    step = max(1, int(np.sqrt(stack.shape[1] * stack.shape[2] / PIXELS)))
    pixels = to_256(stack[:, ::step, ::step])
    pixels = pixels.reshape(*pixels.shape[:3], -1)
    seen = slice(None) if valid is None else _seen_in_all(valid, stack)[::step, ::step]
    ranks = (np.arange(count) + 0.5) / count
    Z = np.empty((count, len(pixels), pixels.shape[-1]), np.intp)
    for j, frame in enumerate(pixels):
        for c in range(pixels.shape[-1]):
            histogram = np.bincount(frame[..., c][seen].ravel(), minlength=256)
            cumulative = np.cumsum(histogram)
            Z[:, j, c] = np.searchsorted(cumulative, ranks * cumulative[-1], side="right")
    return Z.reshape(count, len(pixels), *stack.shape[3:])


def by_grid(images: ArrayLike, count: int, *, valid: ArrayLike | None = None) -> Samples:
    """Return Z (N, P[, 3]): of a grid of `count` pixels or a few fewer, those that every frame shows."""
    stack = as_stack(images)
    height, width = stack.shape[1:3]
    rows = int(np.clip(np.sqrt(count * height / width), 1, height))
    columns = int(np.clip(count // rows, 1, width))
    y = ((np.arange(rows) + 0.5) * height / rows).astype(int)
    x = ((np.arange(columns) + 0.5) * width / columns).astype(int)
    levels = to_256(stack[:, y[:, None], x]).reshape(len(stack), rows * columns, *stack.shape[3:])
    Z = levels.swapaxes(0, 1).astype(np.intp)
    return Z if valid is None else Z[_seen_in_all(valid, stack)[y[:, None], x].ravel()]


def _seen_in_all(valid: ArrayLike, images: Array) -> NDArray[np.bool_]:
    """Return where every frame shows something, (H, W)."""
    everywhere = np.all(as_mask(valid, images), axis=0)
    if not everywhere.any():
        raise ValueError("expected pixels that every frame shows, but the mask leaves none")
    return everywhere
