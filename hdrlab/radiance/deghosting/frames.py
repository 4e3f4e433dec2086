"""Bias and noise of each frame of a bracket, level by level, from the pixels that stand still.

Z      pixel levels      (P, H, W, C), frames from short to long, n = 256 or 65536 levels
g      response          (C, n), ln exposure of each level
rho    residuals         g(Z) - ln t - ln E of a frame, E the plain map
delta  bias              (P, C, n), median of rho over pixels of like levels: a time or a response is off
kappa  spread            (P, C, n), 1.48 times the median deviation of rho, in units of s
s      noise             (C, n), what an error of one level of 256 makes of ln E

Real brackets contradict themselves everywhere: times are rounded, phones tone-map, glare grows with
light. The bias of most pixels of a level is no motion, so it is taken off before motion is looked
for, as far as LARGEST; and a frame is trusted as far as its pixels agree. Most pixels have to stand
still.
"""

from typing import NamedTuple

import numpy as np
from scipy import ndimage

from hdrlab.core.arrays import F64, Array, ArrayLike, Indices, Labels, Mask, as_mask, as_radiance
from hdrlab.errors import InputError
from hdrlab.radiance.merge import CLIPPING_LEVEL, as_tables

# of the levels; each has a bias and a spread
BINS = 32
# pixels that make the median of a bin
FEWEST = 100
# an even choice of about so many represents a frame
PIXELS = 300_000
# ln E: a larger bias is that of a figure that fills its bin, and stays
LARGEST = 0.25
# of kappa: no level is surer than its rounding, and none is worth nothing
LEAST = 1.0
MOST = 8.0


class Calibrated(NamedTuple):
    """A checked bracket: images (P, H, W, C), times (P,), top, valid (P, H, W) or None, and its tables.

    x (P, C, n) is ln E of each level in each frame, s2 (P, C, n) the variance of that.
    """

    images: Array
    times: F64
    top: int
    valid: Mask | None
    x: F64
    s2: F64


def level_noise(curve: F64) -> F64:
    """Return s (C, n) = g'(z) n / 256, how much ln E changes where Z has an error of one level of 256."""
    n = curve.shape[1]
    return np.maximum(n // 256 * np.gradient(curve, axis=1), 1e-4)


def calibrate_frames(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    E: ArrayLike,
    *,
    valid: ArrayLike | None = None,
) -> Calibrated:
    """Return the bracket with each frame's bias and noise, from its still pixels.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16, aligned
    times : (P,) seconds
    g : (n,) or (n, 3), ln exposure of each level
    E : (H, W) or (H, W, 3), the plain map of them
    valid : (P, H, W) bool, optional, False where a photograph holds no picture

    Raises
    ------
    ValueError
        For arrays that do not fit together.

    Examples
    --------
    >>> images = np.array([20, 40, 80], np.uint8)[:, None, None] * np.ones((3, 20, 20), np.uint8)
    >>> linear = np.log(np.maximum(np.arange(256), 0.5) / 128)
    >>> found = calibrate_frames(images, [1, 2.2, 4], linear, np.full((20, 20), 20 / 128))  # it was 2 seconds
    >>> float((128 * np.exp(found.x[1, 0, 40])).round(6))  # as the pixels say, and not 40 / 2.2
    20.0
    """
    stack, seconds, _, curves, first_clipped = as_tables(
        images, times, g, None, "log", CLIPPING_LEVEL
    )
    mask = as_mask(valid, stack)
    Z = stack.reshape(*stack.shape[:3], -1)
    E = as_radiance(E)
    if E.shape != stack.shape[1:]:
        raise InputError(f"expected a map of shape {stack.shape[1:]}, got {E.shape}")
    s = level_noise(curves.T)
    x = curves.T - np.log(seconds)[:, None, None]
    step = max(1, int(np.sqrt(E.shape[0] * E.shape[1] / PIXELS)))
    with np.errstate(divide="ignore"):
        lE = np.log(E[::step, ::step]).reshape(-1, Z.shape[-1])
    s2 = np.empty_like(x)
    for j, frame in enumerate(Z):
        levels_of = frame[::step, ::step].reshape(-1, Z.shape[-1])
        counts = np.all(levels_of < first_clipped, axis=1) & np.isfinite(lE).all(axis=1)
        if mask is not None:
            counts &= mask[j, ::step, ::step].ravel()
        for c, z in enumerate(levels_of[counts].T):
            delta, kappa = fit_bias(z, x[j, c, z] - lE[counts, c], s[c])
            x[j, c] -= delta
            s2[j, c] = (kappa * s[c]) ** 2
    return Calibrated(Z, seconds, first_clipped, mask, x, s2)


def fit_bias(Z: Array, rho: F64, s: F64) -> tuple[F64, F64]:
    """Return delta (n,) and kappa (n,) of a frame's channel from the residuals (N,) of levels Z (N,)."""
    n = len(s)
    at = (np.arange(BINS) + 0.5) * n / BINS
    inside = Z > 0  # level 0 is a bound, and no measurement
    Z = Z[inside]
    rho = rho[inside]
    order = np.argsort(Z.astype(np.intp) * BINS // n, kind="stable")
    counts = np.bincount(Z.astype(np.intp) * BINS // n, minlength=BINS)
    groups = np.split(order, np.cumsum(counts)[:-1])
    deltas, kappas = np.full((2, BINS), np.nan)
    for k, group in enumerate(groups):
        if len(group) >= FEWEST:
            deltas[k] = np.median(rho[group])
            kappas[k] = 1.48 * np.median(np.abs(rho[group] - deltas[k]) / s[Z[group]])
    known = np.abs(deltas) < LARGEST
    if not known.any():
        return np.zeros(n), np.ones(n)
    delta, kappa = (np.interp(np.arange(n), at[known], one[known]) for one in (deltas, kappas))
    return delta, np.clip(kappa, LEAST, MOST)


def mean_losses(taken: Calibrated, labels: Labels) -> F64:
    """Return the mean loss of each frame in each region, (P, R).

    A level costs the variance of its ln E, and 1, the most, where it measures nothing.
    """
    cost = np.minimum(taken.s2, 1.0).astype(np.float32)
    boxes = ndimage.find_objects(labels)
    cost[..., 0] = cost[..., taken.top :] = 1
    out = np.ones((len(taken.images), len(boxes)))
    for j, r in np.ndindex(*out.shape):
        inside = labels[boxes[r]] == r + 1
        Z = taken.images[j][boxes[r]][inside]
        loss = np.mean([cost[j, c][Z[:, c]] for c in range(Z.shape[1])], axis=0)
        shown = True if taken.valid is None else taken.valid[j][boxes[r]][inside]
        out[j, r] = np.where(shown, loss, 1).mean()
    return out


def best_exposures(taken: Calibrated, labels: Labels) -> Indices:
    """Return the best exposure of each region (R,): the frame of least loss."""
    return mean_losses(taken, labels).argmin(axis=0)
