"""Spatially nonuniform scaling (Chiu, Herf, Shirley, Swamy, Wang, Zimmerman, Graphics Interface 1993).

L     luminance          (H, W) >= 0, any linear unit
s     scale              (H, W), 1 / unit of L
k     headroom           a pixel that is k times as bright as its neighbourhood becomes white
base  edge-aware mean    (H, W), the mean of similar neighbours, from which s should have been computed
Ld    display luminance  s L, (H, W), 1 = white

The eye does not notice a scale that varies slowly. Where L jumps, the blur begins to change before
L does: the bright side of an edge darkens the dark side, and the dark side brightens the bright
one. That is the halo.

[Battiato08] has k = 8 and a blur of 15 pixels, which is about 1.6 % of the published pictures. So
narrow a blur follows the light so closely that a dim hall comes out as bright as its windows. The
default here is 8 %: a dark place stays darker than a bright one. The halos are wide, and no width
removes them.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.core import extremes, steps
from hdrlab.core.arrays import F32, ArrayLike, as_luminance
from hdrlab.core.filters.bilateral import bilateral
from hdrlab.errors import InputError

LAWS = ("exposure",)
# of the longer side; with a narrower blur, every place becomes as bright as every other
SIGMA_FRACTION = 0.08
# luminance, in medians
MAX_RELATIVE_LUMINANCE = np.float32(1e30)
SMALLEST_DIVISOR = 1e-37


class State(NamedTuple):
    """The scale s after some smoothing passes, and the luminance L that it multiplies, each (H, W)."""

    s: F32
    L: F32

    @property
    def Ld(self) -> F32:
        """The display luminance s L, computed on access."""
        return self.s * self.L


def choose_sigma(L: F32, sigma: float | None = None) -> float:
    """Return sigma in pixels; the default, None, is 8 % of the longer side."""
    return SIGMA_FRACTION * max(L.shape) if sigma is None else sigma


def divide_by_median(L: F32) -> F32:
    """Return L divided by its median, and limited to 1e30 so that sums stay finite in float32."""
    median = np.float32(max(extremes.positive_median(L), SMALLEST_DIVISOR))
    with np.errstate(over="ignore"):
        return np.minimum(L / median, MAX_RELATIVE_LUMINANCE)


def scale(L: F32, *, headroom: float = 8.0, sigma: float | None = None) -> F32:
    """Return s = 1 / (k blur(L)) [Battiato08 eq. 1.28, whose further factor L is a misprint]."""
    return 1 / np.maximum(headroom * gaussian_filter(L, choose_sigma(L, sigma)), SMALLEST_DIVISOR)


def clamp(s: F32, L: F32) -> F32:
    """Return min(s, 1 / L): no pixel above white [Chiu93]."""
    return np.minimum(s, 1 / np.maximum(L, SMALLEST_DIVISOR))


def smooth(s: F32, L: F32) -> F32:
    """Return s averaged with its neighbours, with weights 1 2 1 along both axes, and clamped again.

    The weights 1 2 1 come from adding pairs twice: first neighbours, then neighbouring sums.
    """
    s = np.pad(s, 1, mode="edge") * np.float32(1 / 16)
    for _ in range(2):
        s = s[:-1] + s[1:]
        s = s[:, :-1] + s[:, 1:]
    return clamp(s, L)


def tonemap_steps(
    L: F32, *, headroom: float = 8.0, sigma: float | None = None, passes: int = 16
) -> Iterator[State]:
    """Yield the State with the clamped scale, and the State after each smoothing pass.

    The brightest 0.01 % of the pixels are limited to the value below them: otherwise a hot pixel
    would darken everything that the blur reaches.
    """
    limited = np.minimum(L, np.float32(extremes.robust_maximum(L)))
    s = clamp(scale(limited, headroom=headroom, sigma=sigma), L)
    yield State(s, L)
    for _ in range(passes):
        s = smooth(s, L)
        yield State(s, L)


def halo(
    L: F32, s: F32, *, headroom: float = 8.0, sigma: float | None = None, contrast: float = 0.4
) -> F32:
    """Return the halo log2(s k base) in stops: the scale s relative to one without a halo, 1 / (k base).

    A positive value is a bright halo, a negative one a dark halo. The base is a bilateral mean as
    wide as the blur, over neighbours that differ by up to about `contrast` decades.
    """
    floor = 1e-6 * max(extremes.positive_median(L), SMALLEST_DIVISOR)
    lL = np.log10(np.maximum(L, floor))
    base = bilateral(lL, sigma_s=choose_sigma(L, sigma), sigma_r=contrast).mean
    return np.log2(s * np.float32(headroom)) + base * np.float32(np.log2(10))


def tonemap(
    L: ArrayLike, *, headroom: float = 8.0, sigma: float | None = None, passes: int = 16
) -> F32:
    """Return display luminance, scaled at each pixel by the mean luminance of its neighbourhood.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    headroom : k; with 2 the neighbourhood's mean becomes 0.5, with little room above; 8 is usual
    sigma : standard deviation of the blur in pixels; None takes 8 % of the longer side
    passes : smoothing passes over the clamped scale; the paper has many more

    Returns
    -------
    (H, W) float32 in [0, 1], 1 = white

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and at least 0, and parameters out of range.

    References
    ----------
    Chiu, Herf, Shirley, Swamy, Wang, Zimmerman, Spatially nonuniform scaling functions for high
    contrast images, Graphics Interface 1993.

    Examples
    --------
    >>> tonemap(np.full((20, 30), 5.0), headroom=4)[10, 15].item()
    0.25
    """
    L = as_luminance(L)
    if not (headroom > 0 and choose_sigma(L, sigma) > 0 and passes >= 0):
        raise InputError(
            f"expected headroom and sigma > 0, passes >= 0, got {headroom=}, {sigma=}, {passes=}"
        )
    relative = divide_by_median(L)
    states = tonemap_steps(relative, headroom=headroom, sigma=sigma, passes=passes)
    return np.clip(steps.last(states).Ld, 0, 1)
