"""Fast bilateral filtering for the display of high-dynamic-range images (Durand and Dorsey, SIGGRAPH 2002).

L         luminance              (H, W) >= 0, any linear unit
lL         log10 L                (H, W), decades; all logarithms here have the base 10
base      large-scale light      (H, W), decades: lL by the bilateral filter, smooth but for its edges
detail    lL - base               (H, W), decades [Battiato08 step 3 has the sign reversed]
k         pixels behind a base   (H, W), 1 to 2 pi sigma_s^2
c         contrast of the base   decades, log10 of `contrast`
m         compression            c / (range of the base), at most 1
Ld        display luminance      10^(m base + detail), (H, W), 1 = white

Light varies over decades and slowly; reflectance varies little and fast. Only the light is compressed. Unlike
Chiu's blur the base does not cross an edge, so there is no halo. But what differs by less than sigma_r is no
edge: beside gentle steps, as of the patches of a chart, the picture glows a little.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.arrays import as_luminance
from hdrlab.core.bands import banded
from hdrlab.core.bilateral import Filtered, bilateral
from hdrlab.core.blur import gaussian
from hdrlab.core.extremes import robust_maximum

Float = NDArray[np.float32]

LAWS = ("exposure",)
WIDTH = 0.02  # sigma_s of the longer side
DARK = 1e-6  # of the median: what is darker has no more detail
NEAR = 2  # sigma in pixels of the blur that stands in for a doubtful base
TINY = 1e-37
ENOUGH = 1 << 18  # pixels that percentiles are taken from


class Layers(NamedTuple):
    """The two layers of lL = base + detail, each (H, W), decades."""

    base: Float
    detail: Float


def logarithm(L: Float) -> Float:
    """Return lL = log10 L, and for black the level of a millionth of the median."""
    floor = np.float32(max(DARK * robust_maximum(L, cut=0.5), TINY))
    return banded(lambda L: np.log(np.maximum(L, floor)) * np.float32(1 / np.log(10)), L)


def certain(found: Filtered, *, sigma_s: float) -> Float:
    """Return the base, and where it rests on few pixels its neighbourhood's instead [Durand02].

    A pixel unlike all around it is its own base: without detail, and compressed like light. The weight of the
    bilateral mean rises with log k, as in the paper, here from one pixel, 0, to the root of all, 1; what
    takes its place is blurred by NEAR pixels.
    """
    enough = np.float32((2 * np.pi * sigma_s**2) ** 0.5)
    if enough <= 1 or not (found.k.min() < enough):
        return found.mean

    def base(mean: Float, k: Float) -> Float:
        doubtful = k < enough
        if not doubtful.any():
            return mean
        u = np.log(np.maximum(k[doubtful], 1)) / np.log(enough)
        near, mean = gaussian(mean, NEAR)[doubtful], mean.copy()
        mean[doubtful] += (1 - u) * (near - mean[doubtful])
        return mean

    return banded(base, found.mean, found.k, margin=4 * NEAR)


def layers(lL: Float, *, sigma_s: float, sigma_r: float = 0.4) -> Layers:
    """Return base = bil(lL) and detail = lL - base."""
    base = certain(bilateral(lL, sigma_s=sigma_s, sigma_r=sigma_r), sigma_s=sigma_s)
    return Layers(base, lL - base)


def spread(base: Float, *, cut: float = 0.01) -> tuple[float, float]:
    """Return the levels that a fraction `cut` of the base lies below, and above."""
    some = base.ravel()[:: -(-base.size // ENOUGH)]
    low, high = np.quantile(some, [cut, 1 - cut])
    return float(low), float(high)


def compressed(base: Float, low: float, high: float, *, contrast: float = 50.0) -> Float:
    """Return m (base - high), m = c / (high - low) [Battiato08 eq. 1.29, 1.30], anchored at the bright end.

    No scene is stretched: m is at most 1.
    """
    m = min(1.0, np.log10(contrast) / max(high - low, 1e-6))
    return np.float32(m) * (base - np.float32(high))


def combined(base: Float, detail: Float) -> Float:
    """Return 10^(base + detail)."""
    return np.exp((base + detail) * np.float32(np.log(10)))


def tonemap(
    L: ArrayLike,
    *,
    contrast: float = 50.0,
    sigma_s: float | None = None,
    sigma_r: float = 0.4,
    cut: float = 0.01,
) -> Float:
    """Return display luminance with the light's contrast compressed and all detail kept.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    contrast : ratio that the base keeps between its percentiles; c = log10(contrast)
    sigma_s : how wide the base is smoothed, pixels; None takes 2 % of the longer side
    sigma_r : what difference is an edge, decades
    cut : fraction of the base beyond its range at either end, and of the picture that may be white

    Returns
    -------
    (H, W) float32 in [0, 1], 1 = white

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and positive or zero, and knobs out of range.

    References
    ----------
    Durand and Dorsey, Fast bilateral filtering for the display of high-dynamic-range images, SIGGRAPH 2002.

    Examples
    --------
    >>> L = np.where(np.arange(60) < 30, 1.0, 10000.0) * np.ones((40, 1))
    >>> tonemap(L, contrast=50)[20, [10, 50]].round(3)
    array([0.02, 1.  ], dtype=float32)
    """
    L = as_luminance(L)
    sigma_s = WIDTH * max(L.shape) if sigma_s is None else sigma_s
    if not (1 < contrast < np.inf and 0 <= cut < 0.5):
        raise ValueError(f"expected contrast > 1 and a cut in [0, 0.5), got {contrast=} and {cut=}")
    base, detail = layers(logarithm(L), sigma_s=sigma_s, sigma_r=sigma_r)
    low, high = spread(base, cut=cut)

    def display(base: Float, detail: Float) -> Float:
        return np.minimum(combined(compressed(base, low, high, contrast=contrast), detail), 1)

    return banded(display, base, detail)
