"""Two photographs on one scale: linear light, divided by exposure, kept within the range that both measure.

Z        gray photograph    (H, W): the green channel
g        response           (n,), ln exposure of each level
k        exposure ratio     brighter / darker
X        light              (2, H, W) float32: exp g(Z) of the brighter photograph, which stays, and of the
                            darker, which moves, times k [Cerman06 sec. 6]; NaN where it is discarded
low      noise level        the darker photograph's, on the common scale
high     saturation level   the brighter photograph's

What lies below `low` or above `high` in either photograph is discarded in both, so the same parts of the
scene are left. Where a level of the pyramid averages, it counts as `low` and `high`, which both share.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import gaussian_filter

from hdrlab.core.arrays import Array, as_table, levels
from hdrlab.core.colour import decode_srgb

Float = NDArray[np.float32]
Mask = NDArray[np.bool_]
Table = NDArray[np.float64]

DARK, BRIGHT = 5 / 255, 250 / 255  # of the range of levels: noise below, saturation above
SMALLEST = 32  # pixels: a level with a side below twice this is not halved again
SMOOTH = 1.0  # pixels: interpolation smooths the noise, so places between pixels would seem to fit better
AROUND = 4.0  # pixels of a level: its neighbourhood


def gray(image: Array) -> Array:
    """Return Z."""
    return image if image.ndim == 2 else image[..., 1]


def pair(fixed: Array, moving: Array, g: ArrayLike | None, k: float | None = None) -> list[Float]:
    """Return X (2, H, W) of the brighter photograph `fixed` and the darker `moving`, and of smaller ones.

    Each is half the size of the one before. Without g each pixel is divided by the mean around it, so that
    what is wrong with a scale taken out of the histograms cancels.
    """
    dark, bright = tables(moving, fixed, g, k)
    n = len(dark) - 1
    low, high = np.float32(dark[round(DARK * n)]), np.float32(bright[round(BRIGHT * n)])
    X = np.stack([bright[fixed], dark[moving]]).astype(np.float32)
    found = pyramid(np.clip(X, low, max(low, high)), (X > low) & (X < high))
    return found if g is not None else [np.stack([x / around(x) for x in X]) for X in found]


def tables(dark: Array, bright: Array, g: ArrayLike | None, k: float | None = None) -> tuple[Table, Table]:
    """Return the light of each level, of the darker photograph and of the brighter, on one scale.

    With g, and with k out of the histograms where it is not given. Without g the darker photograph is brought
    to the brighter one by histograms alone, and both are read by the curve of sRGB: what is wrong with that
    is wrong in both alike.
    """
    n = levels(bright)
    if g is None:
        own = decode_srgb(np.arange(n) / (n - 1))
        return np.interp(transfer(dark, bright), np.arange(n), own), own
    table = as_table(g, n)
    own = np.exp(table if table.ndim == 1 else table[:, 1])
    return own * (ratio(dark, bright, np.log(own)) if k is None else k), own


def transfer(dark: Array, bright: Array) -> Table:
    """Return T (n,), the level in `bright` of what is z in `dark`: that of equal rank [Grossberg03]."""
    n = levels(bright)
    ranks = []
    for Z in (dark, bright):
        h = np.bincount(Z.ravel(), minlength=n)
        ranks.append((np.cumsum(h) - h / 2) / Z.size)
    return np.interp(ranks[0], ranks[1], np.arange(n))


def ratio(dark: Array, bright: Array, g: Table) -> float:
    """Return k from the histograms, which need no alignment: the median of what both measure.

    Examples
    --------
    >>> Z = np.arange(8, 60, dtype=np.uint8).reshape(4, 13)
    >>> round(ratio(Z, 3 * Z, np.log(np.arange(256) + 1e-9)), 3)
    3.0
    """
    z, T, top = np.arange(len(g)), transfer(dark, bright), len(g) - 1
    both = (np.minimum(z, T) > DARK * top) & (np.maximum(z, T) < BRIGHT * top)
    h = np.bincount(dark.ravel(), minlength=len(g))[both]
    if not h.any():
        return 1.0
    steps = np.interp(T, z, g)[both] - g[both]
    order = np.argsort(steps)
    below = np.cumsum(h[order])
    return float(np.exp(steps[order][np.searchsorted(below, below[-1] / 2)]))


def pyramid(X: Float, kept: Mask) -> list[Float]:
    """Return X (2, h, w) at every size, full resolution first, NaN where it is not kept."""
    found: list[Float] = []
    while True:
        smooth = gaussian_filter(X, (0, SMOOTH, SMOOTH))
        found.append(np.where(kept, smooth, np.float32(np.nan)))
        if min(X.shape[1:]) < 2 * SMALLEST:
            return found
        X, kept = halved(X), halved(kept.astype(np.float32)) > 0.7


def halved(X: Float) -> Float:
    """Return X (2, h, w) at half the size: the mean of each 2 x 2 pixels."""
    h, w = X.shape[1] // 2, X.shape[2] // 2
    return np.asarray(X[:, : 2 * h, : 2 * w].reshape(2, h, 2, w, 2).mean(axis=(2, 4)))


def around(x: Float) -> Float:
    """Return the mean of x (h, w) around each pixel, of what is kept."""
    kept = np.isfinite(x)
    total, share = (gaussian_filter(one, AROUND) for one in (np.where(kept, x, 0), kept.astype(np.float32)))
    return np.asarray(total / np.maximum(share, 1e-6), np.float32)
