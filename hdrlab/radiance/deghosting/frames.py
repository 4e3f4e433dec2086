"""What each frame of a bracket says of its levels, and how surely, learned from the pixels that stand still.

Z      pixel levels      (P, H, W, C), frames from short to long, n = 256 or 65536 levels
g      response          (C, n), ln exposure of each level
rho    residuals         g(Z) - ln t - ln E of a frame, E the plain map
delta  bias              (P, C, n), median of rho over pixels of like levels: a time or a response is off
kappa  spread            (P, C, n), 1.48 times the median deviation of rho, in units of s
s      noise             (C, n), what an error of one level of 256 makes of ln E

Real brackets contradict themselves everywhere: times are rounded, phones tone-map, glare grows with light.
What a frame says of most pixels of a level is no motion, so it is taken off before motion is looked for, as
far as LARGEST; and a frame is trusted as far as its pixels agree. Most pixels have to stand still.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import Array, as_mask, as_radiance, as_stack, as_table, as_times, levels

Float = NDArray[np.float64]
BINS = 32  # of the levels; each has a bias and a spread
FEWEST = 100  # pixels that speak for a bin
PIXELS = 300_000  # an even choice of about so many speaks for a frame
LARGEST = 0.25  # ln E: a larger bias is a figure's that fills its bin, and stays
LEAST, MOST = 1.0, 8.0  # of kappa: no level is surer than its rounding, and none is worth nothing


class Photographs(NamedTuple):
    """A checked bracket: images (P, H, W, C), times (P,), top, valid (P, H, W) or None, and its tables.

    x (P, C, n) is ln E of each level in each frame, s2 (P, C, n) the variance of that.
    """

    images: Array
    times: Float
    top: int
    valid: NDArray[np.bool_] | None
    x: Float
    s2: Float


def curves(g: ArrayLike, n: int, channels: int) -> Float:
    """Return g of each channel (C, n)."""
    table = as_table(g, n).reshape(n, -1)
    if table.shape[1] not in (1, channels):
        raise ValueError(f"expected a response of 1 or {channels} channels, got {table.shape[1]}")
    return np.broadcast_to(table, (n, channels)).T


def noise(curve: Float) -> Float:
    """Return s (C, n) = g'(z) n / 256, how much ln E changes where Z has an error of one level of 256."""
    n = curve.shape[1]
    return np.maximum(n // 256 * np.gradient(curve, axis=1), 1e-4)


def photographs(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    E: ArrayLike,
    *,
    top: float = 0.98,
    valid: ArrayLike | None = None,
) -> Photographs:
    """Return the bracket with what its still pixels teach of its frames.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16, aligned
    times : (P,) seconds
    g : (n,) or (n, 3), ln exposure of each level
    E : (H, W) or (H, W, 3), the plain map of them
    top : levels above this fraction of the top level are clipped
    valid : (P, H, W) bool, optional, False where a photograph holds no picture

    Raises
    ------
    ValueError
        For arrays that do not fit together.

    Examples
    --------
    >>> images = np.array([20, 40, 80], np.uint8)[:, None, None] * np.ones((3, 20, 20), np.uint8)
    >>> linear = np.log(np.maximum(np.arange(256), 0.5) / 128)
    >>> found = photographs(images, [1, 2.2, 4], linear, np.full((20, 20), 20 / 128))  # it was 2 seconds
    >>> float((128 * np.exp(found.x[1, 0, 40])).round(6))  # as the pixels say, and not 40 / 2.2
    20.0
    """
    stack = as_stack(images)
    seconds, mask, n = as_times(times, len(stack)), as_mask(valid, stack), levels(stack)
    Z, E = stack.reshape(*stack.shape[:3], -1), as_radiance(E)
    if E.shape != stack.shape[1:]:
        raise ValueError(f"expected a map of shape {stack.shape[1:]}, got {E.shape}")
    if not 0 < top <= 1:
        raise ValueError(f"expected top as a fraction of the top level, 0 to 1, got {top}")
    first_clipped = min(int(top * (n - 1)) + 1, n - 1)
    curve = curves(g, n, Z.shape[-1])
    s = noise(curve)
    x = curve - np.log(seconds)[:, None, None]
    step = max(1, int(np.sqrt(E.shape[0] * E.shape[1] / PIXELS)))
    few = (slice(None, None, step), slice(None, None, step))
    with np.errstate(divide="ignore"):
        lE = np.log(E[few]).reshape(-1, Z.shape[-1])
    s2 = np.empty_like(x)
    for j, frame in enumerate(Z):
        levels_of = frame[few].reshape(-1, Z.shape[-1])
        counts = np.all(levels_of < first_clipped, axis=1) & np.isfinite(lE).all(axis=1)
        if mask is not None:
            counts &= mask[j][few].ravel()
        for c, z in enumerate(levels_of[counts].T):
            delta, kappa = bias(z, x[j, c, z] - lE[counts, c], s[c])
            x[j, c] -= delta
            s2[j, c] = (kappa * s[c]) ** 2
    return Photographs(Z, seconds, first_clipped, mask, x, s2)


def bias(Z: Array, rho: Float, s: Float) -> tuple[Float, Float]:
    """Return delta (n,) and kappa (n,) of a frame's channel from the residuals (N,) of levels Z (N,)."""
    n = len(s)
    at = (np.arange(BINS) + 0.5) * n / BINS
    inside = Z > 0  # level 0 is a bound, and no measurement
    Z, rho = Z[inside], rho[inside]
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
