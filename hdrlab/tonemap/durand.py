"""Fast bilateral filtering for the display of high-dynamic-range images (Durand and Dorsey, SIGGRAPH 2002).

L         luminance              (H, W) >= 0, any linear unit
lL        log10 L                (H, W), decades; all logarithms here have the base 10
base      large-scale light      (H, W), decades: lL by the bilateral filter, smooth but for its edges
detail    lL - base              (H, W), decades [Battiato08 step 3 has the sign reversed]
k         sum of the weights     (H, W), 1 to 2 pi sigma_s^2: how many pixels the base comes from
u         certainty of the base  (H, W), log k / log root(2 pi sigma_s^2), 0 to 1
c         contrast of the base   decades, log10 of `contrast`
m         compression            c / (range of the base), at most 1
Ld        display luminance      10^(m base + detail), (H, W), 1 = white

Light varies slowly, over decades; reflectance varies fast, over much less. Only the light is
compressed. Unlike Chiu's blur, the base does not cross an edge, so there is no halo. But a
difference of less than sigma_r is no edge: next to gentle steps, such as the patches of a chart,
the picture glows a little.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.core.arrays import F32, ArrayLike, as_luminance
from hdrlab.core.extremes import positive_median
from hdrlab.core.filters.bilateral import bilateral
from hdrlab.errors import InputError

LAWS = ("exposure",)
# of the longer side
SIGMA_S_FRACTION = 0.02
# relative to the median luminance; darker pixels have no detail
MIN_RELATIVE_LUMINANCE = 1e-6
# sigma in pixels of the blur that replaces an uncertain base
UNCERTAIN_SIGMA = 2
# percentiles are computed from about this many pixels
PERCENTILE_PIXELS = 2**18


class Layers(NamedTuple):
    """The two layers of lL = base + detail, each (H, W), decades."""

    base: F32
    detail: F32


def logarithm(L: F32) -> F32:
    """Return lL = log10 L, where L is at least a millionth of its median."""
    floor = np.float32(max(MIN_RELATIVE_LUMINANCE * positive_median(L), 1e-37))
    return np.log(np.maximum(L, floor)) * np.float32(1 / math.log(10))


def fix_uncertain(mean: F32, k: F32, *, sigma_s: float) -> F32:
    """Return u mean + (1 - u) blur(mean): a base that rests on few pixels k is fixed [Durand02].

    A pixel unlike all around it is its own base: without detail, and compressed like light. The
    certainty u rises with log k, as in the paper, here from one pixel, 0, to the root of all, 1.
    """
    enough = (2 * math.pi * sigma_s**2) ** 0.5
    if enough <= 1 or k.min() >= enough:
        return mean
    u = np.log(np.clip(k, 1, enough)) / math.log(enough)
    return mean + (1 - u) * (gaussian_filter(mean, UNCERTAIN_SIGMA) - mean)


def layers(lL: F32, *, sigma_s: float, sigma_r: float = 0.4) -> Layers:
    """Return base = bil(lL) and detail = lL - base."""
    base = fix_uncertain(*bilateral(lL, sigma_s=sigma_s, sigma_r=sigma_r), sigma_s=sigma_s)
    return Layers(base, lL - base)


def base_range(base: F32, *, cut: float = 0.01) -> tuple[float, float]:
    """Return the percentiles of the base: a fraction `cut` lies below the first and above the second."""
    every = 1 + base.size // PERCENTILE_PIXELS
    low, high = np.quantile(base.ravel()[::every], [cut, 1 - cut])
    return float(low), float(high)


def compress(base: F32, low: float, high: float, *, contrast: float = 50.0) -> F32:
    """Return m (base - high), m = c / (high - low) [Battiato08 eq. 1.29, 1.30], anchored at the bright end.

    No scene is stretched: m is at most 1. The paper's range of the base is its maximum minus its
    minimum; `tonemap` takes percentiles, so that one pixel does not decide.
    """
    return min(1.0, math.log10(contrast) / max(high - low, 1e-6)) * (base - high)


def combine(base: F32, detail: F32) -> F32:
    """Return 10^(base + detail)."""
    return np.exp((base + detail) * np.float32(math.log(10)))


def tonemap(
    L: ArrayLike,
    *,
    contrast: float = 50.0,
    sigma_s: float | None = None,
    sigma_r: float = 0.4,
    cut: float = 0.01,
) -> F32:
    """Return display luminance with compressed contrast of the base and unchanged detail.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    contrast : ratio that the base keeps between its percentiles, c = log10(contrast): 5 in the
        paper; 50 in Battiato et al. 2008, which is the default
    sigma_s : spatial width of the bilateral filter in pixels; None takes 2 % of the longer side
    sigma_r : its width in range, decades; a larger difference is an edge
    cut : fraction of the base that lies beyond its range at either end, and so of the picture that
        may become white

    Returns
    -------
    (H, W) float32 in [0, 1], 1 = white

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and at least 0, and parameters out of range.

    References
    ----------
    Durand and Dorsey, Fast bilateral filtering for the display of high-dynamic-range images,
    SIGGRAPH 2002.

    Examples
    --------
    >>> L = np.where(np.arange(60) < 30, 1.0, 10000.0) * np.ones((40, 1))
    >>> tonemap(L, contrast=50)[20, [10, 50]].round(3)
    array([0.02, 1.  ], dtype=float32)
    """
    L = as_luminance(L)
    if sigma_s is None:
        sigma_s = SIGMA_S_FRACTION * max(L.shape)
    if not (1 < contrast < np.inf and 0 <= cut < 0.5):
        raise InputError(f"expected contrast > 1 and a cut in [0, 0.5), got {contrast=} and {cut=}")
    if L.max() == 0:
        return np.zeros_like(L)
    base, detail = layers(logarithm(L), sigma_s=sigma_s, sigma_r=sigma_r)
    low, high = base_range(base, cut=cut)
    return np.minimum(combine(compress(base, low, high, contrast=contrast), detail), 1)
