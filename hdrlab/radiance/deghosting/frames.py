"""Bias and noise of each frame of a bracket at every level, estimated from static pixels.

Z      pixel levels      (P, H, W, C), frames from short to long, n = 256 or 65536 levels
g      response          (C, n), ln exposure of each level
rho    residuals         g(Z) - ln t - ln E of a frame, E the plain map
delta  bias              (P, C, n), median of rho over pixels of like levels: a time or a response is off
kappa  spread            (P, C, n), 1.48 times the median deviation of rho, in units of s
s      noise             (C, n), what an error of one level of 256 makes of ln E

The frames of real brackets contradict each other everywhere: times are rounded, phones tone-map,
and glare grows with the light. A bias that most pixels of a level share is not motion. So it is
subtracted before motion is detected, up to a limit, and the spread of the residuals says how far a
frame can be trusted. Most pixels of the scene must be static.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from hdrlab.core.arrays import F64, Array, ArrayLike, Indices, Labels, Mask, as_mask, as_radiance
from hdrlab.errors import InputError
from hdrlab.radiance.merge import CLIPPING_LEVEL, as_tables

# bins of the levels; each has a bias and a spread
BIN_COUNT = 32
MIN_PIXELS_PER_BIN = 100
# a regular grid of about this many pixels represents a frame
SAMPLED_PIXELS = 300_000
# in ln E; a larger bias comes from something that moved and fills its bin, and is not subtracted
MAX_BIAS = 0.25
# no level is more certain than its rounding
MIN_KAPPA = 1.0
MAX_KAPPA = 8.0
# loss of a clipped pixel that is darker in all frames that measure it; that of others is at most 1
UNFILLED_LOSS = 4.0
# additional loss of a clipped pixel that another frame can fill: it may show another moment
FILLED_LOSS = 0.25


@dataclass(frozen=True)
class Calibrated:
    """A checked bracket with its calibration tables.

    Attributes
    ----------
    images : (P, H, W, C)
    times : (P,), seconds
    top : first clipped level
    valid : (P, H, W) bool, or None
    x : (P, C, n), ln E of each level in each frame
    s2 : (P, C, n), variance of x
    """

    images: Array
    times: F64
    top: int
    valid: Mask | None
    x: F64
    s2: F64


def level_noise(curve: F64) -> F64:
    """Return s (C, n) = g'(z) n / 256, the change of ln E for an error of one level of 256."""
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
    """Return the bracket with bias and noise of each frame, estimated from static pixels.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16, aligned
    times : (P,) seconds
    g : (n,) or (n, 3), ln exposure of each level
    E : (H, W) or (H, W, 3), the plain map of them
    valid : (P, H, W) bool, optional, False where a photograph shows nothing of the scene

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
    step = max(1, int(np.sqrt(E.shape[0] * E.shape[1] / SAMPLED_PIXELS)))
    with np.errstate(divide="ignore"):
        lE = np.log(E[::step, ::step]).reshape(-1, Z.shape[-1])
    s2 = np.empty_like(x)
    for j, frame in enumerate(Z):
        sampled = frame[::step, ::step].reshape(-1, Z.shape[-1])
        in_use = np.all(sampled < first_clipped, axis=1) & np.isfinite(lE).all(axis=1)
        if mask is not None:
            in_use &= mask[j, ::step, ::step].ravel()
        for c, z in enumerate(sampled[in_use].T):
            rho = x[j, c, z] - lE[in_use, c]
            delta, kappa = fit_bias(z, rho, s[c])
            x[j, c] -= delta
            s2[j, c] = (kappa * s[c]) ** 2
    return Calibrated(images=Z, times=seconds, top=first_clipped, valid=mask, x=x, s2=s2)


def fit_bias(Z: Array, rho: F64, s: F64) -> tuple[F64, F64]:
    """Return delta (n,) and kappa (n,) of a frame's channel from the residuals rho (N,) of levels Z (N,)."""
    n = len(s)
    bin_centres = (np.arange(BIN_COUNT) + 0.5) * n / BIN_COUNT
    measured = Z > 0  # level 0 is only an upper bound
    Z = Z[measured]
    rho = rho[measured]
    bins = Z.astype(np.intp) * BIN_COUNT // n
    order = np.argsort(bins, kind="stable")
    counts = np.bincount(bins, minlength=BIN_COUNT)
    groups = np.split(order, np.cumsum(counts)[:-1])
    deltas = np.full(BIN_COUNT, np.nan)
    kappas = np.full(BIN_COUNT, np.nan)
    for k, group in enumerate(groups):
        if len(group) >= MIN_PIXELS_PER_BIN:
            deltas[k] = np.median(rho[group])
            kappas[k] = 1.48 * np.median(np.abs(rho[group] - deltas[k]) / s[Z[group]])
    known = np.abs(deltas) < MAX_BIAS
    if not known.any():
        return np.zeros(n), np.ones(n)
    levels = np.arange(n)
    delta = np.interp(levels, bin_centres[known], deltas[known])
    kappa = np.interp(levels, bin_centres[known], kappas[known])
    return delta, np.clip(kappa, MIN_KAPPA, MAX_KAPPA)


def mean_losses(taken: Calibrated, labels: Labels) -> F64:
    """Return the mean loss of each frame in each region, (P, R).

    The loss of a level is the variance of its ln E, at most 1, and 1 where it measures nothing. A
    pixel's loss is the mean over its channels. A pixel that is clipped in any channel has no color.
    The longest other frame that measures it and is not darker fills it. Then the loss is that of
    this frame plus FILLED_LOSS, because it may show another moment. If all frames that measure the
    pixel are darker, the loss is UNFILLED_LOSS. If none measures it, the loss is 1.
    """
    cost = np.minimum(taken.s2, 1.0).astype(np.float32)
    cost[..., 0] = 1
    cost[..., taken.top :] = 1
    channels = np.arange(taken.images.shape[-1])
    order = np.argsort(taken.times)
    losses = np.ones((len(taken.images), int(labels.max())))
    for r, box in enumerate(ndimage.find_objects(labels)):
        inside = labels[box] == r + 1
        Z = taken.images[:, *box][:, inside]
        shown = np.ones(Z.shape[:2], bool)
        if taken.valid is not None:
            shown = taken.valid[:, *box][:, inside]
        pixel_costs = np.stack([cost[j, channels, Z[j]].mean(axis=-1) for j in range(len(Z))])
        measures = shown & (Z < taken.top).all(axis=-1)
        for j in range(len(Z)):
            is_clipped = Z[j] >= taken.top
            bounds = np.where(is_clipped, taken.x[j, :, taken.top] - MAX_BIAS, -np.inf)
            loss = np.where(measures.any(axis=0), UNFILLED_LOSS, 1.0)
            for k in order:
                fills = measures[k] & (taken.x[k, channels, Z[k]] >= bounds).all(axis=-1)
                loss[fills] = np.minimum(pixel_costs[k][fills] + FILLED_LOSS, 1)
            loss = np.where(is_clipped.any(axis=-1), loss, pixel_costs[j])
            losses[j, r] = np.where(shown[j], loss, 1).mean()
    return losses


def best_exposures(taken: Calibrated, labels: Labels) -> Indices:
    """Return the best exposure of each region (R,): the frame with the smallest loss."""
    return mean_losses(taken, labels).argmin(axis=0)
