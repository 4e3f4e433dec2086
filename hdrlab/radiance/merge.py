"""The radiance map: the weighted mean of what the frames measure at each pixel (Debevec and Malik 1997).

Z      pixel levels      (P, H, W, C), n = 256 or 65536 of them
t, B   exposure times    (P,) seconds, and ln t
g      ln f^-1           (n,) or (n, C), ln exposure of each level; X = exp(g(Z))
w      weights           (n,), how far to trust a level
W      weights in use    (P, H, W, C), w(Z), or 0 where a frame measures nothing
top    first clipped level; levels from there on are lower bounds, level 0 is an upper bound
shown  (P, H, W, C) bool, False where a frame shows nothing of the scene
E      radiance          (H, W[, C]) float32: 1 brings a pixel to level n / 2 in one second

A frame that does not measure a pixel still bounds it: if frame j is clipped, the radiance is at
least f^-1(top) / t_j; if frame j is dark, it is at most f^-1(1) / t_j. So a clipped sun is never
darker than the measured sky next to it. `fast.merge` computes the same map with look-up tables.

Mitsunaga and Nayar divide by scaled exposures, whose mean is 1, and not by times [sec. 6.3]. That
changes the unit of the map and nothing else.
"""

from enum import IntFlag
from typing import NamedTuple

import numpy as np

from hdrlab.core import arrays
from hdrlab.core.arrays import F32, F64, Array, ArrayLike, Flags, Mask
from hdrlab.core.weights import hat
from hdrlab.errors import InputError
from hdrlab.radiance.stuck import repair_stuck

# levels above this fraction of the top level are clipped
CLIPPING_LEVEL = 0.98
# relative to the largest weight: negligible where another frame measures the pixel
MIN_RELATIVE_WEIGHT = 1e-6


class Quality(IntFlag):
    """Pixel quality flags: MEASURED, or why not."""

    MEASURED = 0
    # clipped in every frame that shows it: E is the lower bound from the shortest frame
    CLIPPED = 1
    # dark in every frame: E is the upper bound from the longest frame; with CLIPPED, between the two
    DARK = 2
    # the level does not follow the exposure: E is the median of the neighbours
    STUCK = 4
    # no frame shows it: E is 0
    UNSEEN = 8


class Merged(NamedTuple):
    """The radiance map (H, W[, 3]) float32, and the quality flags of its pixels (H, W) uint8."""

    E: F32
    quality: Flags


def log_mean(W: F64, X: F64, t: F64) -> F64:
    """Return E of ln E = sum W (ln X - ln t) / sum W [Debevec97 eq. 6]."""
    return np.exp(np.sum(W * np.log(X / t), axis=0) / W.sum(axis=0))


def likelihood(W: F64, X: F64, t: F64) -> F64:
    """Return E = sum W X t / sum W t^2 [Robertson03 eq. 8]: best for equal noise in every frame."""
    return np.sum(W * X * t, axis=0) / np.sum(W * t**2, axis=0)


def frame_mean(W: F64, X: F64, t: F64) -> F64:
    """Return E = sum W (X / t) / sum W [Battiato08 eq. 1.20]: the mean of all radiances.

    Examples
    --------
    >>> float(frame_mean(np.ones(2), np.array([0.25, 0.5]), np.array([1.0, 2.0])))
    0.25
    """
    return np.sum(W * X / t, axis=0) / W.sum(axis=0)


def shot_noise(W: F64, X: F64, t: F64) -> F64:
    """Return E = sum W X / sum W t, all light over all time: best where photon noise dominates."""
    return np.sum(W * X, axis=0) / np.sum(W * t, axis=0)


METHODS = {"log": log_mean, "likelihood": likelihood, "mean": frame_mean, "shot": shot_noise}


def weigh(Z: Array, w: F64, top: int, shown: Mask | bool = True) -> F64:
    """Return W: w(Z) where a frame measures a pixel, 0 elsewhere.

    A frame with a clipped channel is dropped for all channels if another frame measures the pixel:
    cameras clip before their color matrix, so the other channels of a clipped pixel are wrong, too,
    and highlights would have a tint.
    """
    usable = (Z > 0) & (Z < top) & shown
    whole = usable & np.all(Z < top, axis=-1, keepdims=True)
    in_use = np.where(whole.any(axis=0), whole, usable)
    return in_use * np.maximum(w[Z], MIN_RELATIVE_WEIGHT * w.max())


def bound(Z: Array, B: F64, g: F64, top: int, shown: Mask) -> tuple[F64, Flags]:
    """Return E (M,) and flags (M,) of pixels Z (P, M) that no frame measures, from the tightest bounds.

    ln E >= g(top) - B_j where frame j is clipped, ln E <= g(1) - B_j where it is dark. With one of
    them E is that bound, with both the middle of their logarithms, with none 0. The flags are the
    sum of 1 if a frame is clipped and 2 if one is dark, or 8 if there is neither.
    """
    B = np.reshape(B, (-1,) + (1,) * (Z.ndim - 1))
    lower = np.where(shown & (Z >= top), g[top] - B, -np.inf).max(axis=0)
    upper = np.where(shown & (Z == 0), g[1] - B, np.inf).min(axis=0)
    low = np.isfinite(lower)
    high = np.isfinite(upper)
    bound_count = 1.0 * low + high
    lE = (np.where(low, lower, 0) + np.where(high, upper, 0)) / np.maximum(bound_count, 1)
    flags = 1 * low + 2 * high + 8 * ~(low | high)  # Quality
    return np.where(low | high, np.exp(lE), 0.0), flags.astype(np.uint8)


def merge(images: ArrayLike, times: ArrayLike, g: ArrayLike, w: ArrayLike | None = None) -> F32:
    """Return the radiance map, ln E = sum_j w(Z_j) (g(Z_j) - ln t_j) / sum_j w(Z_j) [Debevec97 eq. 6].

    Where no frame measures a pixel, E comes from the tightest bounds. Images are (P, H, W[, 3]), in
    any order; w is the hat by default.

    Examples
    --------
    >>> images = np.array([[[40, 90]], [[80, 180]]], np.uint8)  # a linear camera, one and two seconds
    >>> E = merge(images, [1, 2], np.log(np.maximum(np.arange(256), 0.5) / 128))
    >>> bool(np.allclose(E, [[40 / 128, 90 / 128]]))
    True
    """
    if np.ma.is_masked(images):
        raise InputError("some levels are masked; pass the mask to merge_with_quality as `valid`")
    images = np.asarray(images)
    t = np.asarray(times, np.float64)
    g = np.asarray(g, np.float64)
    if (
        images.dtype.kind != "u"
        or images.ndim < 3
        or images.shape[3:] not in ((), (3,))
        or not images.size
    ):
        raise InputError(f"expected photographs (P, H, W[, 3]), got {images.dtype} {images.shape}")
    if t.shape != images.shape[:1] or not np.all((t > 0) & (t < np.inf)):
        raise InputError(f"expected {len(images)} positive times in seconds, got {t}")
    n = np.iinfo(images.dtype).max + 1
    Z = images.reshape(*images.shape[:3], -1)
    B = np.log(t)
    c = np.arange(Z.shape[-1])
    top = int(CLIPPING_LEVEL * (n - 1)) + 1
    if (
        g.shape not in ((n,), (n, 1), (n, c.size))
        or not np.all(np.abs(g) < 80)
        or not np.all(g[-1] > g[0])
    ):
        raise InputError(
            f"expected g ({n},) or ({n}, {len(c)}) that rises, -80 to 80, got {g.shape}"
        )
    g = np.broadcast_to(np.reshape(g, (n, -1)), (n, len(c)))
    w = hat(n) if w is None else np.asarray(w, np.float64)
    if w.shape != (n,) or not np.all((w >= 0) & (w < np.inf)) or not w.any():
        raise InputError(f"expected weights ({n},), not negative and not all 0, got {w.shape}")
    W = weigh(Z, w, top)
    total = W.sum(axis=0)
    lE = np.sum(W * (g[Z, c] - B[:, None, None, None]), axis=0) / np.where(total > 0, total, 1)
    bounds, _ = bound(Z, B, g, top, np.ones(Z.shape, bool))
    E = np.where(total > 0, np.exp(lE), bounds)
    return E.reshape(images.shape[1:]).astype(np.float32)


def merge_with_quality(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    w: ArrayLike | None = None,
    *,
    method: str = "log",
    top: float = CLIPPING_LEVEL,
    repair: bool = True,
    valid: ArrayLike | None = None,
) -> Merged:
    """Return the radiance map by one of METHODS, with stuck pixels repaired, and its quality flags.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Aligned photographs, in any order.
    times : (P,) float
        Exposure times in seconds.
    g : (n,) or (n, 3) float
        Response, ln exposure of each level; interpolated where n is not the images' number of
        levels.
    w : (n,) float, optional
        Weights, the hat by default.
    method : {"log", "likelihood", "mean", "shot"}
        The quotient of sums to use, a key of `METHODS`.
    top : float
        Levels above this fraction of the top level are clipped.
    repair : bool
        Replace single pixels that do not follow the exposure by their neighbours' median.
    valid : (P, H, W) bool, optional
        False where a photograph shows nothing of the scene.

    Returns
    -------
    Merged
        E (H, W) or (H, W, 3) float32, finite and not negative, and quality (H, W) uint8.

    Raises
    ------
    ValueError
        For arrays that do not fit together, or an unknown method.

    References
    ----------
    Debevec and Malik, SIGGRAPH 1997, sec. 2.2; Robertson, Borman and Stevenson, Journal of
    Electronic Imaging 2003, eq. 8.

    Examples
    --------
    >>> images = np.array([[[40, 255]], [[80, 255]]], np.uint8)
    >>> found = merge_with_quality(images, [1, 2], np.log(np.maximum(np.arange(256), 0.5) / 128))
    >>> [Quality(flag).name for flag in found.quality[0]]
    ['MEASURED', 'CLIPPED']
    """
    stack, t, w, curves, first = as_tables(images, times, g, w, method, top)
    mask = arrays.as_mask(valid, stack)
    Z = stack.reshape(*stack.shape[:3], -1)
    shown = np.broadcast_to(True if mask is None else mask[..., None], Z.shape)
    W = weigh(Z, w, first, shown)
    X = np.exp(curves[Z, np.arange(Z.shape[-1])])
    bounds, flags = bound(Z, np.log(t), curves, first, shown)
    measured = W.any(axis=0)
    with np.errstate(invalid="ignore"):
        means = METHODS[method](W, X, t[:, None, None, None])
    E = np.where(measured, means, bounds).astype(np.float32)
    quality = np.bitwise_or.reduce(np.where(measured, np.uint8(0), flags), axis=-1)
    if repair:
        quality[repair_stuck(E, stack, t, mask)] = Quality.STUCK
    return Merged(E.reshape(stack.shape[1:]), quality)


def as_tables(
    images: ArrayLike, times: ArrayLike, g: ArrayLike, w: ArrayLike | None, method: str, top: float
) -> tuple[Array, F64, F64, F64, int]:
    """Return the checked stack, its times, w (n,), g (n, C) and the first clipped level."""
    stack = arrays.as_stack(images)
    n = arrays.levels(stack)
    channels = stack[0, 0, 0].size
    w = arrays.as_table(hat(n) if w is None else w, n)
    curves = arrays.as_response(g, n, channels)
    if w.ndim != 1 or not np.all(w >= 0) or not w.any():
        raise InputError(f"expected weights (n,), not negative and not all 0, got shape {w.shape}")
    if method not in METHODS:
        raise InputError(f"expected one of the methods {', '.join(METHODS)}, got {method!r}")
    if not 0 < top <= 1:
        raise InputError(f"expected top as a fraction of the top level, 0 to 1, got {top}")
    first = min(int(top * (n - 1)) + 1, n - 1)
    return stack, arrays.as_times(times, len(stack)), w, curves, first
