"""Which pixels to trust with a calibration (Mitsunaga and Nayar, CVPR 1999, sec. 6.1 and 6.2).

A        frames        (t, H, W) of one exposure, brightness 0 ... 1
s        pixels        of a patch around each pixel, 5 x 5
sigma_t  noise of one frame;   sigma_s  spread of the averaged frames over a patch
psi      rejection ratio   share of flat patches that the test loses, 0.05
r        radius        pixels from the middle of the picture

A patch that shows one even surface has only noise in it. The average of t frames has the variance
sigma_t^2 / t: it is with this, and not with sigma_t^2, that the spread over a patch of the average
must be compared. Against the noise of one frame, as eq. 12 is printed, the test would be t times
too lax. sigma_t^2 is here the mean of the patch's estimates. As it is an estimate, its threshold
is a quantile of Fisher's F, which becomes chi^2 for many frames.

Frames of different apertures differ, away from the middle, by their vignetting too. Inside some
circle they do not. The paper prints "the smallest circle" in which the levels of one frame against
those of the other form a compact curve; it means the largest. It gives no criterion, and that of
`circle` is this library's.
"""

from typing import NamedTuple

import numpy as np
from scipy.ndimage import binary_erosion, uniform_filter
from scipy.stats import chi2, f

from hdrlab.core.arrays import F64, ArrayLike, Mask, as_stack, describe, to_256
from hdrlab.errors import InputError


class Average(NamedTuple):
    """The mean (H, W) of t frames, the variance (H, W) of one frame, and t."""

    mean: F64
    variance: F64
    t: int


def temporal_average(A: ArrayLike, *, sigma: float = 0.01) -> Average:
    """Return mean and variance over t frames (t, H, W); of a single frame the variance is sigma^2."""
    A = np.asarray(A, np.float64)
    if A.ndim != 3 or A.size == 0 or not np.all(np.isfinite(A)):
        raise InputError(f"expected finite frames of one exposure (t, H, W), got {describe(A)}")
    variance = A.var(axis=0, ddof=1) if len(A) > 1 else np.full(A.shape[1:], sigma**2)
    return Average(A.mean(axis=0), variance, len(A))


def spatial_average(mean: ArrayLike, *, size: int = 5) -> tuple[F64, F64]:
    """Return mean and variance sigma_s^2 over the s = size^2 pixels around each pixel, both (H, W)."""
    mean = np.asarray(mean, np.float64)
    middle = mean.mean()  # taken off first, lest squares drown the differences
    local = uniform_filter(mean - middle, size)
    square = uniform_filter((mean - middle) ** 2, size)
    return local + middle, np.maximum(square - local**2, 0)


def threshold(s: int = 25, *, psi: float = 0.05, estimated: float = np.inf) -> float:
    """Return what s sigma_s^2 / sigma^2 of a flat patch exceeds by chance psi: chi^2_{s-1}(psi) [eq. 12].

    Where sigma^2 is itself an estimate, of that many degrees of freedom, it is (s - 1) F_{s-1,
    estimated}(psi).
    """
    if s < 2 or not 0 < psi < 1 or estimated <= 0:
        raise InputError(f"expected s of at least 2 and psi in (0, 1), got {s} and {psi}")
    if np.isinf(estimated):
        return float(chi2.isf(psi, s - 1))
    return float((s - 1) * f.isf(psi, s - 1, estimated))


def flat(A: ArrayLike, *, size: int = 5, psi: float = 0.05, sigma: float = 0.01) -> Mask:
    """Return where the patch around a pixel is flat, (H, W).

    Parameters
    ----------
    A : (t, H, W) float, 0 to 1
        Frames of one exposure.
    size : int
        Side of the patch, pixels.
    psi : float
        The fraction of flat patches that the test rejects.
    sigma : float
        Noise of a single frame, if A has only one.

    Returns
    -------
    (H, W) bool
        True where s sigma_s^2 / (sigma_t^2 / t) <= the threshold; False within size // 2 of the
        border.

    Raises
    ------
    ValueError
        For frames that are not (t, H, W), a size below 2, a psi not between 0 and 1, or a sigma
        that is not above 0.

    Examples
    --------
    >>> noise = np.random.default_rng(0).normal(0.5, 0.01, (1, 60, 60))
    >>> bool(0.9 < flat(noise)[2:-2, 2:-2].mean() < 0.99)
    True
    """
    if size < 2 or not sigma > 0:
        raise InputError(
            f"expected a patch of 2 x 2 pixels or more, noise above 0, got {size} and {sigma}"
        )
    mean, variance, t = temporal_average(A, sigma=sigma)
    s = size**2
    estimated = s * (t - 1) if t > 1 else np.inf
    # as sigma_t is even over a flat patch, its s estimates are one
    noise = uniform_filter(variance, size) / t
    _, spread = spatial_average(mean, size=size)
    passed = s * spread <= threshold(s, psi=psi, estimated=estimated) * noise
    return passed & binary_erosion(np.ones(passed.shape), np.ones((3, 3)), iterations=size // 2)


def radius(shape: tuple[int, int]) -> F64:
    """Return each pixel's distance from the middle of the picture, (H, W) pixels."""
    y, x = [np.arange(extent) - (extent - 1) / 2 for extent in shape]
    return np.hypot(y[:, None], x)


def circle(A: ArrayLike, B: ArrayLike, *, tolerance: float = 1.0, rings: int = 40) -> float:
    """Return the radius, in pixels, of the circle in which two aligned frames have no vignetting [sec. 6.2].

    What level of B goes with a level of A is learned in the inmost quarter; ring after ring must
    then agree with it within `tolerance` levels in the median. The circle ends where two rings in a
    row do not.
    """
    a, b = to_256(as_stack([A, B])).astype(np.float64)
    r = radius(a.shape[:2])
    outer = r.max()
    usable = (a > 4) & (a < 250) & (b > 4) & (b < 250)
    heart = usable & (r < outer / 4)
    count = np.bincount(a[heart].astype(int), minlength=256)
    known = np.flatnonzero(count)
    if len(known) < 2:
        raise InputError("expected pixel values in the middle that neither frame clips, got none")
    T = np.bincount(a[heart].astype(int), b[heart], 256)[known] / count[known]
    usable &= (a >= known[0]) & (a <= known[-1])
    miss = b - np.interp(a, known, T)
    edges = np.linspace(outer / 4, outer, rings + 1)
    off = np.zeros(rings + 1, bool)
    for i in range(rings):
        ring = miss[usable & (r >= edges[i]) & (r < edges[i + 1])]
        off[i] = len(ring) > 0 and abs(np.median(ring)) > tolerance
    off[-1] = off[-2]
    ends = np.flatnonzero(off[:-1] & off[1:])
    return float(edges[ends[0]] if len(ends) else outer)
