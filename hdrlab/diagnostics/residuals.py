"""Residuals of a response, frame by frame and level by level.

Z   pixel levels     (N, P[, 3]) integers 0 ... 255: sample i in frame j
B   ln times         (P,)
w   weights          (256,)
g   response         (n,) or (n, 3), ln exposure of each level
lE  ln irradiance    (N[, 3]), each sample's best: sum_j w^2 (g(Z_ij) - B_j) / sum_j w^2
r   residuals        (N, P[, 3]), g(Z_ij) - lE_i - B_j, in stops

All are 0 where the camera is the one that g and the times describe. A frame that lies off as a whole has a
wrong time; a level that lies off in all frames, a wrong g; a level that lies off differently from frame to
frame belongs to a camera that treats each photograph in its own way. Every frame has a share in lE: where two
contradict each other by a stop, each shows a part of it.
"""

import numpy as np
from numpy.typing import ArrayLike

from hdrlab.core import weights
from hdrlab.core.arrays import as_response, as_stack, as_table, as_times
from hdrlab.core.metrics import RELIABLE_LEVELS
from hdrlab.core.sampling import by_grid
from hdrlab.core.types import F64
from hdrlab.diagnostics.consistency import measure_level_exposures


def residuals(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    *,
    samples: int = 100_000,
    w: ArrayLike | None = None,
    valid: ArrayLike | None = None,
) -> F64:
    """Return the median residual of each frame, level and channel.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs, aligned; 16 bits are read at 256 levels.
    times : (P,) float
        Exposure times in seconds.
    g : (n,) or (n, 3) float
        Response, ln exposure of each level; one curve serves all channels.
    samples : int
        How many pixels to look at, on an even grid.
    w : (256,) float, optional
        Weights; the hat, cut above 0.98 of the top level.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.

    Returns
    -------
    (P, 256) or (P, 256, 3) float64
        Stops; NaN at levels that fewer than 50 samples of a frame have, and where w is 0.

    Raises
    ------
    ValueError
        For arrays that do not fit together.

    Examples
    --------
    >>> ramp = np.linspace(1, 100, 40_000).reshape(200, 200)
    >>> images = np.clip(np.round(ramp * np.array([1, 2])[:, None, None]), 0, 255).astype(np.uint8)
    >>> linear = np.log(np.maximum(np.arange(256), 0.25) / 128)
    >>> r = residuals(images, [0.01, 0.021], linear)  # the second frame's time is 0.07 stops too long
    >>> bool(abs(r[0, 90] - 0.05) < 0.03), bool(abs(r[1, 180] + 0.02) < 0.03)
    (True, True)
    """
    stack = as_stack(images)
    t, w = as_times(times, len(stack)), weights.cut(weights.hat()) if w is None else as_table(w, 256)
    few = by_grid(stack, samples, valid=valid)
    Z = few.reshape(*few.shape[:2], -1)
    curve, W = as_response(g, 256, Z.shape[-1]), w[Z] ** 2
    apart = W * (curve[Z, np.arange(Z.shape[-1])] - np.log(t)[:, None])
    lE = apart.sum(axis=1) / np.maximum(W.sum(axis=1), 1e-12)
    E = np.where((W > 0).sum(axis=1) >= 2, np.exp(lE), 0)
    few = few.swapaxes(0, 1)[:, :, None].astype(np.uint8)
    medians = measure_level_exposures(few, t, E.reshape(few.shape[1:]))
    r = np.where(w > 0, curve.T / np.log(2) - medians, np.nan)
    return np.moveaxis(r, 1, 2).reshape(len(stack), 256, *stack.shape[3:])


def rms(r: ArrayLike) -> float:
    """Return the root of the mean squared residual of the levels 10 to 250, in stops; NaN for none."""
    known = np.asarray(r, np.float64)[:, RELIABLE_LEVELS]
    known = known[np.isfinite(known)]
    return float(np.sqrt(np.mean(known**2))) if known.size else float("nan")


def frame_offsets(r: ArrayLike) -> F64:
    """Return the offset of each frame as a whole (P,), in stops: the median of its levels, or NaN."""
    frames = np.asarray(r, np.float64)
    known = [one[np.isfinite(one)] for one in frames]
    return np.array([np.median(one) if one.size else np.nan for one in known])
