"""How much of the picture stands elsewhere in each photograph?

x    ln E           (P, H, W, C), of each frame alone: g(Z) - ln t
w    weights        (P, H, W, C), of levels that are neither clipped nor black
r    residuals      x - (sum_j w x) / (sum_j w)
R    of a block     (P, h, w), sum w r / sum w over its pixels and channels, so that noise averages out, less
                    the frame's median: where a frame is off as a whole, its time or the response is
d    deviation      (h, w), sqrt(sum_j W R^2 / sum_j W), W the sum of w over the block
b    of a row       (P, h), sum w r / sum w over a row of blocks, less the frame's best cubic in y

Leaves, water and people make d large where they are, though most pixels of each level agree, so
that a median over levels, as in `consistency`, does not see them. An edge that is off by a pixel
does so along a line; what counts is at least two blocks wide and high.

Lamps flicker, and most cameras read row after row: then b has bands, and the same of columns has
none. A sky above the ground, where a response is a little wrong, makes no bands, for a cubic
explains it.
"""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from hdrlab.core.arrays import F32, Array, ArrayLike, as_mask
from hdrlab.radiance.merge import CLIPPING_LEVEL, as_tables

# of a frame, on an even grid, that stand for the whole
PIXELS = 180_000
# side, in pixels of the grid
BLOCK = 4
# mean weight, of the highest, of a frame that measures a block
FAINT = 0.2
# ln E by which the frames of a still scene may differ in a block: 0.2 stops
STILL = 0.2 * np.log(2)
# of the blocks: where fewer are measured by two frames, nothing is known
FEWEST = 0.1
# of the blocks measured: of a still scene up to 0.012 deviate; of film scanned frame by frame 0.09,
# for its response does, and then `radiance.deghosting.ghosts` finds nothing to remove
MOVED = 0.015
# stops of b, and times what columns show: still scenes under steady light stay below 0.04, and 1.8
BANDED, ACROSS = 0.055, 2.5


def measure_motion(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    w: ArrayLike,
    *,
    valid: ArrayLike | None = None,
) -> tuple[float, float]:
    """Return the share of the picture in which the photographs contradict each other, and by bands of light.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16, aligned
    times : (P,) seconds
    g : (n,) or (n, 3), ln exposure of each level
    w : (n,), weights of the levels
    valid : (P, H, W) bool, optional, False where a photograph holds no picture

    Returns
    -------
    share, bands : float
        The share is one of the blocks that two photographs measure; 0 where these are few. Above
        MOVED, it is motion. Bands are the RMS of b in stops, 0 unless it is ACROSS times that of
        columns. Above BANDED, lamps flicker.

    Raises
    ------
    ValueError
        For arrays that do not fit together.

    Examples
    --------
    >>> from hdrlab.capture import movers, responses
    >>> wall, ball = np.full((60, 90), 0.5, np.float32), movers.ball((60, 90), (30, 45), 12, 2.0)
    >>> for step in (0, 30):
    ...     taken = movers.shoot(wall, ball, movers.path(3, (0, step)), [0.25, 0.5, 1.0]).bracket
    ...     measure_motion(taken.images, taken.times, responses.true_g("film"), np.ones(256))[0] > MOVED
    False
    True
    """
    stack, t, w, curves, top = as_tables(images, times, g, w, "log", CLIPPING_LEVEL)
    mask, every = (
        as_mask(valid, stack),
        max(1, int(np.sqrt(stack[0].size / curves.shape[1] / PIXELS))),
    )
    few = np.s_[:, ::every, ::every]
    Z = np.moveaxis(stack[few].reshape(*stack[few].shape[:3], -1), -1, 0).copy()
    seen = (Z < top).all(axis=0) if mask is None else (Z < top).all(axis=0) & mask[few]
    weight = np.where(np.arange(len(w)) > 0, w / w.max(), 0).astype(np.float32)
    R, W = np.zeros(
        (2, len(t), *(n // BLOCK for n in Z.shape[2:])), np.float32
    )  # sums of w r, and of w
    for levels, x in zip(Z, curves.T.astype(np.float32), strict=True):
        trust = weight.take(levels) * seen
        r = x.take(levels) - np.log(t).astype(np.float32)[:, None, None]
        r -= (trust * r).sum(axis=0) / np.maximum(trust.sum(axis=0), 1e-9)
        R += sum_blocks(trust * r)
        W += sum_blocks(trust)
    rows, columns = (
        measure_bands(R.sum(axis=k), W.sum(axis=k), len(Z) * R.shape[k]) for k in (2, 1)
    )
    W[W < FAINT * BLOCK**2 * len(Z)] = 0
    R /= np.maximum(W, 1e-9)
    for one, own in zip(R, W, strict=True):
        one -= np.median(one[own > 0]) if own.any() else 0
    d = np.sqrt((W * R**2).sum(axis=0) / np.maximum(W.sum(axis=0), 1e-9))
    measured = (W > 0).sum(axis=0) > 1
    whole = sliding_window_view(np.pad(measured & (d > STILL), 1), (2, 2)).all(axis=(2, 3))
    moved = sliding_window_view(whole, (2, 2)).any(axis=(2, 3))
    share = float(moved.sum() / measured.sum()) if np.mean(measured) > FEWEST else 0.0
    return share, rows * (rows > ACROSS * columns)


def measure_bands(R: F32, W: F32, count: int) -> float:
    """Return the RMS of b in stops, from sums of w r and of w (P, n) over so many blocks and channels."""
    W = np.where(W > FAINT / 2 * BLOCK**2 * count, W, 0)
    b, A = R / np.maximum(W, 1e-9), np.vander(np.linspace(-1, 1, R.shape[1]), 4)
    for one, own in zip(b, np.sqrt(W), strict=True):
        one -= A @ np.linalg.lstsq(own[:, None] * A, own * one, rcond=None)[0]
    W[:, (W > 0).sum(axis=0) < 2] = 0
    return float(np.sqrt((W * b**2).sum() / max(W.sum(), 1e-9)) / np.log(2))


def sum_blocks(values: Array) -> F32:
    """Return the sums over blocks of BLOCK x BLOCK pixels, (P, H / BLOCK, W / BLOCK)."""
    h, w = values.shape[1] // BLOCK, values.shape[2] // BLOCK
    rows = values[:, : h * BLOCK].reshape(len(values), h, BLOCK, -1).sum(axis=2, dtype=np.float32)
    return np.asarray(sum(rows[..., k : w * BLOCK : BLOCK] for k in range(BLOCK)), np.float32)
