"""Two photographs on one scale: linear light divided by exposure, and how it differs [Cerman06 sec. 6].

Z      gray photograph     (H, W): the green channel
g      response            (n,), ln exposure of each level
f_inv  light of a level    (n,): exp g
k      exposure ratio      brighter / darker
X      light               (2, H, W) float32: f_inv(Z) of the brighter photograph, which stays, and
                           k f_inv(Z) of the darker, which moves; NaN where it is discarded
low    noise level         the darker photograph's, on the common scale
high   saturation level    the brighter photograph's
H      homography          (3, 3): where pixel (x, y, 1) of the moving photograph lies on the fixed one
p      pixels              (n, 2), (x, y): those of the fixed photograph that are compared
d      differences         (n,): (a - b) / max((a + b) / 2, t), relative to light; NaN where one measures none
t      least light         a thousandth of the largest, so that darkness does not count as contrast
e      error               mean of d^2

What lies below `low` or above `high` in either photograph is discarded in both, so the same parts
of the scene are left. Where a level of the pyramid averages, it counts as `low` and `high`, which
both share.
"""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import scipy

from hdrlab.core.arrays import F32, F64, Array, ArrayLike, Mask
from hdrlab.core.filters import warp
from hdrlab.core.optional import skimage_transform as transform
from hdrlab.core.transfer import brightness_transfer, histograms
from hdrlab.errors import InputError

# of the range of levels: noise below, saturation above
DARK, BRIGHT = 5 / 255, 250 / 255
# pixels: a level with a side below twice this is not halved again
SMALLEST = 32
# pixels: interpolation smooths the noise, so places between pixels would seem to fit better
SMOOTH = 1.0
# pixels of a level: the standard deviation of a local mean
NEIGHBOURHOOD = 4.0
# an even choice of this many pixels measures an error as well as all of them
POINTS = 8_000
# of those pixels both photographs must measure
LEAST = 0.02
# e of photographs of which one is dark wherever the other is bright
NONE = 4.0


def neighbours(images: ArrayLike, times: ArrayLike, g: ArrayLike) -> Iterator[list[F32]]:
    """Yield the pyramid of X of pair after pair, from the shortest exposure to the longest."""
    images, t, g = np.asarray(images), np.asarray(times, np.float64), np.asarray(g, np.float64)
    wrong = images.dtype.kind != "u" or images.ndim < 3 or images.shape[3:] not in ((), (3,))
    if (
        wrong
        or not images.size
        or t.shape != images.shape[:1]
        or not np.all((t > 0) & (t < np.inf))
    ):
        raise InputError(
            f"expected photographs (P, H, W[, 3]), positive times (P,), got {images.shape}, {t}"
        )
    Z, n = images if images.ndim == 3 else images[..., 1], np.iinfo(images.dtype).max + 1
    if g.shape not in ((n,), (n, 3)) or not np.all(np.abs(g) < 80) or not np.all(g[-1] > g[0]):
        raise InputError(f"expected g ({n},) or ({n}, 3) that rises, -80 to 80, got {g.shape}")
    f_inv = np.exp(g if g.ndim == 1 else g[:, 1])
    for moving, fixed in pairwise(np.argsort(t, kind="stable")):
        yield pair(Z[fixed], Z[moving], f_inv, t[fixed] / t[moving] * f_inv)


def pair(fixed: Array, moving: Array, bright: F64, dark: F64) -> list[F32]:
    """Return X at every size by the light (n,) of a level of `fixed`, and of `moving` on the same scale."""
    n = len(dark) - 1
    low, high = np.float32(dark[round(DARK * n)]), np.float32(bright[round(BRIGHT * n)])
    X = np.stack([bright[fixed], dark[moving]]).astype(np.float32)
    return pyramid(np.clip(X, low, max(low, high)), (X > low) & (X < high))


def pyramid(X: F32, kept: Mask) -> list[F32]:
    """Return X (2, h, w) at every size, full resolution first, each half the one before; NaN unless kept."""
    smooth = np.where(
        kept, scipy.ndimage.gaussian_filter(X, (0, SMOOTH, SMOOTH)), np.float32(np.nan)
    )
    h, w = (side // 2 * 2 for side in X.shape[1:])
    if min(h, w) < 2 * SMALLEST:
        return [smooth]
    halve = transform.downscale_local_mean
    X, share = (halve(x[:, :h, :w], (1, 2, 2)) for x in (X, kept.astype(np.float32)))
    return [smooth, *pyramid(X, share > 0.7)]


def local_mean(x: F32) -> F32:
    """Return the mean of x (h, w) around each pixel, of what is kept."""
    kept = np.isfinite(x)
    each = np.stack([np.where(kept, x, 0), kept]).astype(np.float32)
    total, share = scipy.ndimage.gaussian_filter(each, (0, NEIGHBOURHOOD, NEIGHBOURHOOD))
    return np.asarray(total / np.maximum(share, 1e-6), np.float32)


def lattice(shape: tuple[int, ...], points: int = POINTS) -> F64:
    """Return about this many pixels p, spread evenly over a picture."""
    step = max(1, int(np.sqrt(shape[0] * shape[1] / points)))
    y, x = np.mgrid[step // 2 : shape[0] : step, step // 2 : shape[1] : step]
    return np.stack([x.ravel(), y.ravel()], axis=-1).astype(float)


def differences(X: F32, H: F64, p: F64) -> F64:
    """Return d at the pixels p [Cerman06 eq. 6]."""
    q, (x, y) = warp.apply(np.linalg.inv(H), p), p.astype(int).T
    a = X[0][y, x].astype(np.float64)
    b = scipy.ndimage.map_coordinates(X[1], q.T[::-1], order=1, cval=np.nan, output=np.float64)
    t = 1e-3 * np.max(X[0], where=np.isfinite(X[0]), initial=1e-9)
    return np.asarray((a - b) / np.maximum((a + b) / 2, t))


def error(d: F64) -> float:
    """Return e; NONE where the two share too few pixels.

    Examples
    --------
    >>> error(np.array([0.1, -0.3, np.nan]))
    0.05
    """
    measured = d[np.isfinite(d)]
    return float(np.mean(measured**2)) if len(measured) > LEAST * len(d) else NONE


def exposure_ratio(dark: Array, bright: Array, g: F64) -> float:
    """Return k from the histograms, which need no alignment: the median of what both measure.

    Examples
    --------
    >>> Z = np.arange(8, 60, dtype=np.uint8).reshape(4, 13)
    >>> round(exposure_ratio(Z, 3 * Z, np.log(np.arange(256) + 1e-9)), 3)
    3.0
    """
    h_dark, h_bright = histograms([dark, bright])[0]
    z, T, top = np.arange(len(g)), brightness_transfer(h_dark, h_bright), len(g) - 1
    both = (np.minimum(z, T) > DARK * top) & (np.maximum(z, T) < BRIGHT * top)  # NaN is neither
    h = h_dark[both]
    if not h.any():
        return 1.0
    steps = np.interp(T, z, g)[both] - g[both]
    return float(np.exp(np.quantile(steps, 0.5, weights=h, method="inverted_cdf")))
