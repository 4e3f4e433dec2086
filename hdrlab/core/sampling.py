"""Which pixels enter a calibration: a stack of photographs -> Z.

images  (P, H, W[, 3]) uint8 or uint16
valid   (P, H, W) bool, False where a photograph holds no picture; None: all is picture
N       number of samples
Z       (N, P[, 3]) intp, 0 ... 255: sample i as frame j shows it; 16 bits are rounded to these 256 levels

Debevec and Malik picked pixels by hand: well distributed in level, from even regions. Both ways
here do it without hands. `by_grid` follows single pixels through the frames, so the frames must be
aligned. `by_rank` matches equal ranks of the frames' histograms [Grossberg03]: brightness is
monotone in exposure, so the k-th darkest pixel of one frame is the k-th darkest of every other. It
needs no alignment, averages noise away, and spends its samples where the pictures have pixels.
"""

import numpy as np

from hdrlab.core.arrays import Array, ArrayLike, Indices, Mask, as_stack, to_256
from hdrlab.errors import InputError

# an even choice of about so many ranks a frame as well as all of it
PIXELS = 1_000_000


def by_rank(images: ArrayLike, count: int, *, valid: ArrayLike | None = None) -> Indices:
    """Return Z (N, P[, 3]): the level at rank (i + 1/2) / N of each frame's histogram, channel by channel.

    Examples
    --------
    >>> by_rank(np.arange(8, dtype=np.uint8).reshape(1, 2, 4), 4).ravel().tolist()
    [1, 3, 5, 7]
    """
    stack = as_stack(images)
    step = max(1, int(np.sqrt(stack.shape[1] * stack.shape[2] / PIXELS)))
    pixels = to_256(stack[:, ::step, ::step])
    shown = np.s_[:] if valid is None else _shown_in_all(valid, stack)[::step, ::step].ravel()
    pixels = np.moveaxis(pixels.reshape(len(stack), -1, *stack.shape[3:])[:, shown], 1, -1)
    rank = ((np.arange(count) + 0.5) / count * pixels.shape[-1]).astype(int)
    ranked = np.sort(np.ascontiguousarray(pixels), kind="stable")
    return np.moveaxis(ranked[..., rank], -1, 0).astype(np.intp)


def by_grid(images: ArrayLike, count: int, *, valid: ArrayLike | None = None) -> Indices:
    """Return Z (N, P[, 3]): of a grid of `count` pixels or a few fewer, those that every frame shows."""
    stack = as_stack(images)
    height, width = stack.shape[1:3]
    rows = int(np.clip(np.sqrt(count * height / width), 1, min(height, max(count, 1))))
    columns = int(np.clip(count // rows, 1, width))
    y = ((np.arange(rows) + 0.5) * height / rows).astype(int)
    x = ((np.arange(columns) + 0.5) * width / columns).astype(int)
    levels = to_256(stack[:, y[:, None], x]).reshape(len(stack), rows * columns, *stack.shape[3:])
    Z = levels.swapaxes(0, 1).astype(np.intp)
    return Z if valid is None else Z[_shown_in_all(valid, stack)[y[:, None], x].ravel()]


def every_pixel(images: ArrayLike, count: int, *, valid: ArrayLike | None = None) -> Array:
    """Return Z (N, P[, 3]): all pixels that every frame shows, whatever the count."""
    stack = as_stack(images)
    Z = to_256(stack).reshape(len(stack), -1, *stack.shape[3:]).swapaxes(0, 1)
    return Z if valid is None else Z[_shown_in_all(valid, stack).ravel()]


def require_two_exposures(Z: ArrayLike, times: ArrayLike, w: ArrayLike) -> None:
    """Raise a ValueError unless a sample has weight at two levels, at two times: such connect the levels."""
    Z, times, has_weight = np.asarray(Z), np.asarray(times), np.asarray(w) > 0
    if Z.ndim != 2 or Z.dtype.kind not in "iu" or times.shape != Z.shape[1:]:
        raise InputError(
            f"expected levels Z (N, P) and times (P,), got shapes {Z.shape} and {times.shape}"
        )
    for z in (Z[:50], Z):  # the first few connect levels, as a rule
        values = [np.where(has_weight[z], one, np.nan) for one in (times, z)]
        if np.any(
            np.all([np.fmax.reduce(v, axis=1) > np.fmin.reduce(v, axis=1) for v in values], axis=0)
        ):
            return
    raise InputError(
        "expected samples seen well in two exposures, which connect the levels; got none"
    )


def _shown_in_all(valid: ArrayLike, images: Array) -> Mask:
    """Return where every frame shows something, (H, W)."""
    valid = np.asarray(valid, bool)
    if valid.shape != images.shape[:3] or not valid.all(axis=0).any():
        got = (
            "but the mask leaves none" if valid.shape == images.shape[:3] else f"got {valid.shape}"
        )
        raise InputError(
            f"expected a mask of shape {images.shape[:3]} with pixels that all show, {got}"
        )
    return np.asarray(valid.all(axis=0))
