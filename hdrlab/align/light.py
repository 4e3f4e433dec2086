"""Two photographs on one scale: linear light divided by exposure, and how it differs [Cerman06 sec. 6].

Z      gray photograph     (H, W): the green channel
g      response            (n,), ln exposure of each level
f_inv  light of a level    (n,): exp g
k      exposure ratio      brighter / darker
X      light               (2, H, W) float32: f_inv(Z) of the brighter photograph, which stays, and
                           k f_inv(Z) of the darker, which moves; NaN where it is discarded
low    noise limit         light at `DARK_FRACTION` of the darker photograph, on the common scale
high   saturation limit    light at `SATURATED_FRACTION` of the brighter photograph
H      homography          (3, 3): where pixel (x, y, 1) of the moving photograph lies on the fixed one
p      pixels              (n, 2), (x, y): those of the fixed photograph that are compared
d      differences         (n,): (a - b) / max((a + b) / 2, t), relative to light; NaN where one is discarded
t      smallest light      a thousandth of the largest, so that darkness does not count as contrast
e      error               mean of d^2

Light below `low` or above `high` in either photograph is discarded in both, so that the same parts
of the scene are left. The paper gives no value for t and the limits, and sums d^2 where e is a
mean [eq. 6, 7]. In the averages of the coarser levels discarded light counts as `low` or
`high`, which both photographs share.
"""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import scipy

from hdrlab.core.arrays import F32, F64, Array, ArrayLike, Mask, describe
from hdrlab.core.filters import warp
from hdrlab.core.optional import skimage_transform as transform
from hdrlab.core.transfer import brightness_transfer, histograms
from hdrlab.errors import InputError

# fraction of the top level below which noise dominates
DARK_FRACTION = 5 / 255
# fraction of the top level above which a pixel counts as saturated
SATURATED_FRACTION = 250 / 255
# Interpolation smooths noise, so that fractions of pixels would seem to fit better than whole ones.
# Smoothing both photographs first, by this standard deviation in pixels, removes the advantage.
SMOOTHING_SIGMA = 1.0
# standard deviation of a local mean, in pixels of a level
LOCAL_MEAN_SIGMA = 4.0
# error where too few pixels can be compared: that of one photograph dark where the other is bright
ERROR_WITHOUT_OVERLAP = 4.0
# a level is halved as long as the next one has at least this many pixels a side
_MIN_SIDE_PIXELS = 32
# About this many pixels, spread evenly, measure an error as well as all of them.
_LATTICE_PIXELS = 8_000
# fraction of the lattice that both photographs must measure
_MIN_MEASURED_FRACTION = 0.02
# fraction of four pixels that must be measured for their mean to count
_MIN_KEPT_FRACTION = 0.7
# largest absolute ln exposure of a response
_MAX_LN_EXPOSURE = 80


def neighbours(images: ArrayLike, times: ArrayLike, g: ArrayLike) -> Iterator[list[F32]]:
    """Yield the pyramid of X of pair after pair, from the shortest exposure to the longest."""
    images = np.asarray(images)
    t = np.asarray(times, np.float64)
    g = np.asarray(g, np.float64)
    is_stack = images.ndim >= 3 and images.shape[3:] in ((), (3,)) and images.size > 0
    if not is_stack or images.dtype.kind != "u":
        raise InputError(f"expected photographs (P, H, W[, 3]), got {describe(images)}")
    if t.shape != images.shape[:1] or not np.all((t > 0) & (t < np.inf)):
        raise InputError(f"expected {len(images)} positive times in seconds, got {t}")
    n = np.iinfo(images.dtype).max + 1
    is_bounded = np.all(np.abs(g) < _MAX_LN_EXPOSURE)
    if g.shape not in ((n,), (n, 3)) or not is_bounded or not np.all(g[-1] > g[0]):
        limit = _MAX_LN_EXPOSURE
        raise InputError(
            f"expected a rising g ({n},) or ({n}, 3) from -{limit} to {limit}, got {describe(g)}"
        )
    Z = images if images.ndim == 3 else images[..., 1]
    f_inv = np.exp(g if g.ndim == 1 else g[:, 1])
    for moving, fixed in pairwise(np.argsort(t, kind="stable")):
        k = t[fixed] / t[moving]
        yield pair(Z[fixed], Z[moving], f_inv, k * f_inv)


def pair(fixed: Array, moving: Array, bright: F64, dark: F64) -> list[F32]:
    """Return the pyramid of X of two gray photographs.

    `bright` (n,) is the light of each level of `fixed`, `dark` (n,) that of each level of `moving`
    on the same scale.
    """
    top = len(dark) - 1
    low = np.float32(dark[round(DARK_FRACTION * top)])
    high = np.float32(bright[round(SATURATED_FRACTION * top)])
    X = np.stack([bright[fixed], dark[moving]]).astype(np.float32)
    return pyramid(np.clip(X, low, max(low, high)), (X > low) & (X < high))


def pyramid(X: F32, kept: Mask) -> list[F32]:
    """Return X (2, h, w) at every size, full resolution first, each half as large; NaN unless kept."""
    blurred = scipy.ndimage.gaussian_filter(X, (0, SMOOTHING_SIGMA, SMOOTHING_SIGMA))
    smooth = np.where(kept, blurred, np.float32(np.nan))
    h = X.shape[1] // 2 * 2
    w = X.shape[2] // 2 * 2
    if min(h, w) < 2 * _MIN_SIDE_PIXELS:
        return [smooth]
    half = transform.downscale_local_mean(X[:, :h, :w], (1, 2, 2))
    share = transform.downscale_local_mean(kept[:, :h, :w].astype(np.float32), (1, 2, 2))
    return [smooth, *pyramid(half, share > _MIN_KEPT_FRACTION)]


def local_mean(x: F32) -> F32:
    """Return the mean of x (h, w) around each pixel, over the pixels that are not NaN."""
    kept = np.isfinite(x)
    planes = np.stack([np.where(kept, x, 0), kept]).astype(np.float32)
    sigma = (0, LOCAL_MEAN_SIGMA, LOCAL_MEAN_SIGMA)
    total, share = scipy.ndimage.gaussian_filter(planes, sigma)
    return np.asarray(total / np.maximum(share, 1e-6), np.float32)


def lattice(shape: tuple[int, ...], points: int = _LATTICE_PIXELS) -> F64:
    """Return about `points` pixels p, spread evenly over a picture."""
    step = max(1, int(np.sqrt(shape[0] * shape[1] / points)))
    y, x = np.mgrid[step // 2 : shape[0] : step, step // 2 : shape[1] : step]
    return np.stack([x.ravel(), y.ravel()], axis=-1).astype(float)


def differences(X: F32, H: F64, p: F64) -> F64:
    """Return d at the pixels p [Cerman06 eq. 6]."""
    x, y = p.astype(int).T
    q = warp.apply(np.linalg.inv(H), p)
    a = X[0][y, x].astype(np.float64)
    b = scipy.ndimage.map_coordinates(X[1], q.T[::-1], order=1, cval=np.nan, output=np.float64)
    t = 1e-3 * np.max(X[0], where=np.isfinite(X[0]), initial=1e-9)
    return np.asarray((a - b) / np.maximum((a + b) / 2, t))


def error(d: F64) -> float:
    """Return e, or `ERROR_WITHOUT_OVERLAP` where too few pixels can be compared.

    Examples
    --------
    >>> error(np.array([0.1, -0.3, np.nan]))
    0.05
    """
    measured = d[np.isfinite(d)]
    if len(measured) <= _MIN_MEASURED_FRACTION * len(d):
        return ERROR_WITHOUT_OVERLAP
    return float(np.mean(measured**2))


def exposure_ratio(dark: Array, bright: Array, g: F64) -> float:
    """Return the exposure ratio k from the histograms of two photographs, without alignment.

    It is the median over the levels that both photographs measure; 1 where there is none. If g was
    estimated with wrong times of these photographs, k repeats the error.

    Examples
    --------
    >>> Z = np.arange(8, 60, dtype=np.uint8).reshape(4, 13)
    >>> round(exposure_ratio(Z, 3 * Z, np.log(np.arange(256) + 1e-9)), 3)
    3.0
    """
    h_dark, h_bright = histograms([dark, bright])[0]
    z = np.arange(len(g))
    top = len(g) - 1
    T = brightness_transfer(h_dark, h_bright)  # NaN fails both comparisons
    both = (np.minimum(z, T) > DARK_FRACTION * top) & (np.maximum(z, T) < SATURATED_FRACTION * top)
    h = h_dark[both]
    if not h.any():
        return 1.0
    steps = np.interp(T, z, g)[both] - g[both]
    return float(np.exp(np.quantile(steps, 0.5, weights=h, method="inverted_cdf")))
