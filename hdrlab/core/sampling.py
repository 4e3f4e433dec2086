"""Choose the pixels for a calibration: samples Z of a stack of photographs.

images  (P, H, W[, 3]) uint8 or uint16
valid   (P, H, W) bool, False where a photograph holds no picture; None: all is picture
N       number of samples
Z       (N, P[, 3]) intp, 0 ... 255: sample i in frame j; 16 bits are rounded to 256 levels

Debevec and Malik picked pixels by hand: well distributed in level, from uniform regions. Both
functions here do it automatically. `by_grid` follows single pixels through the frames, so the frames must be
aligned. `by_rank` matches equal ranks of the frames' histograms [Grossberg03]: brightness is
monotone in exposure, so the k-th darkest pixel of one frame is the k-th darkest of every other. It
needs no alignment, averages noise away, and spends its samples where the pictures have pixels.
"""

import numpy as np

from hdrlab.core.arrays import Array, ArrayLike, Indices, Mask, as_stack, to_256
from hdrlab.errors import InputError

# A frame with more pixels is thinned to an even grid of about this many: its ranks stay the same.
_MAX_RANKED_PIXELS = 1_000_000
# Nearly every bracket shows two connected exposures within its first samples.
_FIRST_SAMPLES = 50


def by_rank(images: ArrayLike, count: int, *, valid: ArrayLike | None = None) -> Indices:
    """Return Z (N, P[, 3]): the level at rank (i + 1/2) / N of each frame's histogram, channel by channel.

    Examples
    --------
    >>> by_rank(np.arange(8, dtype=np.uint8).reshape(1, 2, 4), 4).ravel().tolist()
    [1, 3, 5, 7]
    """
    stack = as_stack(images)
    step = max(1, int(np.sqrt(stack.shape[1] * stack.shape[2] / _MAX_RANKED_PIXELS)))
    shown = None
    if valid is not None:
        shown = _shown_in_all(valid, stack)[::step, ::step]
    Z = np.empty((count, len(stack), *stack.shape[3:]), np.intp)
    # frame by frame, because a sorted copy of all frames would double the memory
    for j, image in enumerate(stack):
        pixels = to_256(image[::step, ::step])
        pixels = pixels[shown] if shown is not None else pixels.reshape(-1, *stack.shape[3:])
        ranked = np.sort(np.ascontiguousarray(pixels.T), kind="stable")
        rank = ((np.arange(count) + 0.5) / count * len(pixels)).astype(int)
        Z[:, j] = ranked[..., rank].T
    return Z


def by_grid(images: ArrayLike, count: int, *, valid: ArrayLike | None = None) -> Indices:
    """Return Z (N, P[, 3]): the pixels of an even grid of at most `count` that every frame shows."""
    stack = as_stack(images)
    height, width = stack.shape[1:3]
    rows = int(np.clip(np.sqrt(count * height / width), 1, min(height, max(count, 1))))
    columns = int(np.clip(count // rows, 1, width))
    y = ((np.arange(rows) + 0.5) * height / rows).astype(int)
    x = ((np.arange(columns) + 0.5) * width / columns).astype(int)
    levels = to_256(stack[:, y[:, None], x]).reshape(len(stack), rows * columns, *stack.shape[3:])
    Z = levels.swapaxes(0, 1).astype(np.intp)
    if valid is None:
        return Z
    shown = _shown_in_all(valid, stack)[y[:, None], x]
    return Z[shown.ravel()]


def every_pixel(images: ArrayLike, count: int, *, valid: ArrayLike | None = None) -> Array:
    """Return Z (N, P[, 3]): all pixels that every frame shows; `count` is ignored."""
    stack = as_stack(images)
    Z = to_256(stack).reshape(len(stack), -1, *stack.shape[3:]).swapaxes(0, 1)
    if valid is None:
        return Z
    return Z[_shown_in_all(valid, stack).ravel()]


def split_channels(Z: Array) -> Array:
    """Return samples Z (N, P) or (N, P, C) channel by channel, (C, N, P)."""
    return np.moveaxis(Z.reshape(*Z.shape[:2], -1), -1, 0)


def require_two_exposures(Z: ArrayLike, times: ArrayLike, w: ArrayLike) -> None:
    """Raise a ValueError unless some sample has weight at two levels and two times.

    Only such a sample connects levels of the response with each other.
    """
    Z = np.asarray(Z)
    times = np.asarray(times)
    has_weight = np.asarray(w) > 0
    if Z.ndim != 2 or Z.dtype.kind not in "iu" or times.shape != Z.shape[1:]:
        raise InputError(
            f"expected levels Z (N, P) and times (P,), got shapes {Z.shape} and {times.shape}"
        )
    for samples in (Z[:_FIRST_SAMPLES], Z):
        weighted = has_weight[samples]
        if np.any(_differ(times, weighted) & _differ(samples, weighted)):
            return
    raise InputError("expected samples that are well exposed in two photos, got none")


def _differ(values: Array, weighted: Mask) -> Mask:
    """Return for each sample (N,) whether its values differ among the frames that have weight."""
    kept = np.where(weighted, values, np.nan)
    return np.asarray(np.fmax.reduce(kept, axis=1) > np.fmin.reduce(kept, axis=1))


def _shown_in_all(valid: ArrayLike, images: Array) -> Mask:
    """Return the pixels (H, W) that every frame shows."""
    valid = np.asarray(valid, bool)
    if valid.shape != images.shape[:3]:
        raise InputError(f"expected a mask of shape {images.shape[:3]}, got {valid.shape}")
    shown = np.asarray(valid.all(axis=0))
    if not shown.any():
        raise InputError("expected pixels that are valid in every photo, but the masks leave none")
    return shown
