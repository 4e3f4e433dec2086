"""Spatially nonuniform scaling (Chiu, Herf, Shirley, Swamy, Wang, Zimmerman, Graphics Interface 1993).

L     luminance          (H, W) >= 0, any linear unit
s     scale              (H, W), 1 / unit of L
k     headroom           a pixel that is k times as bright as its neighbourhood becomes white
base  edge-aware mean    (H, W), the mean of neighbours alike: what s should have been taken from
Ld    display luminance  s L, (H, W), 1 = white

The eye does not mind a scale that varies slowly. Where L jumps, the blur begins to change before L
does: the dark side of an edge is held back by the bright one, and the other way round. That is the
halo.

k = 8 and a blur of 15 pixels are those of [Battiato08]. So narrow a blur, some 1.6 % of a picture
as in the published ones, follows the light so closely that a dim hall comes out as bright as its
windows. 8 % is a choice of ours: a place keeps its brightness beside others, and the halos are
wide, as no width removes them.
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
# sigma of the blur, of the longer side: narrower, every place is as bright as every other
WIDTH = 0.08
# luminance in medians
LIMIT = np.float32(1e30)
TINY = 1e-37


class State(NamedTuple):
    """The scale s after a number of smoothing passes, and the luminance that it scales, each (H, W)."""

    s: F32
    L: F32

    @property
    def Ld(self) -> F32:
        """The picture s L, made when it is asked for."""
        return self.s * self.L


def choose_sigma(L: F32, sigma: float | None = None) -> float:
    """Return sigma in pixels; None is 8 % of the longer side."""
    return WIDTH * max(L.shape) if sigma is None else sigma


def divide_by_median(L: F32) -> F32:
    """Return L in medians of L, and what is beyond all measure like any other: so sums stay finite."""
    with np.errstate(over="ignore"):
        return np.minimum(L / np.float32(max(extremes.positive_median(L), TINY)), LIMIT)


def scale(L: F32, *, headroom: float = 8.0, sigma: float | None = None) -> F32:
    """Return s = 1 / (k blur(L)) [Battiato08 eq. 1.28, whose further factor L is a misprint]."""
    return 1 / np.maximum(headroom * gaussian_filter(L, choose_sigma(L, sigma)), TINY)


def clamp(s: F32, L: F32) -> F32:
    """Return min(s, 1 / L): no pixel above white [Chiu93]."""
    return np.minimum(s, 1 / np.maximum(L, TINY))


def smooth(s: F32, L: F32) -> F32:
    """Return s averaged with its neighbours, weights 1 2 1 down and across, and clamped again.

    The weights 1 2 1 are those of 1 1, twice: the sum of each pair, and of each pair of sums.
    """
    s = np.pad(s, 1, mode="edge") * np.float32(1 / 16)
    for _ in range(2):
        s = s[:-1] + s[1:]
        s = s[:, :-1] + s[:, 1:]
    return clamp(s, L)


def tonemap_steps(
    L: F32, *, headroom: float = 8.0, sigma: float | None = None, passes: int = 16
) -> Iterator[State]:
    """Yield the State with the clamped scale, and after each smoothing pass.

    The brightest 0.01 % count no more than the next: a hot pixel would darken all that the blur
    reaches.
    """
    s = clamp(
        scale(
            np.minimum(L, np.float32(extremes.robust_maximum(L))), headroom=headroom, sigma=sigma
        ),
        L,
    )
    yield State(s, L)
    for _ in range(passes):
        s = smooth(s, L)
        yield State(s, L)


def halo(
    L: F32, s: F32, *, headroom: float = 8.0, sigma: float | None = None, contrast: float = 0.4
) -> F32:
    """Return log2(s k base), in stops: how much brighter a pixel is than if its own kind alone had scaled it.

    Positive is a bright halo, negative a dark one. The base is a bilateral mean as wide as the
    blur, of neighbours that differ by about `contrast` decades.
    """
    lL = np.log10(np.maximum(L, 1e-6 * max(extremes.positive_median(L), TINY)))
    base = bilateral(lL, sigma_s=choose_sigma(L, sigma), sigma_r=contrast).mean
    return np.log2(s * np.float32(headroom)) + base * np.float32(np.log2(10))


def tonemap(
    L: ArrayLike, *, headroom: float = 8.0, sigma: float | None = None, passes: int = 16
) -> F32:
    """Return display luminance by a scale that follows the brightness of the neighbourhood.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    headroom : k; 2 makes the neighbourhood's mean 0.5 and leaves little room above, 8 is the usual
    sigma : standard deviation of the neighbourhood, pixels; None takes 8 % of the longer side
    passes : smoothing passes over the clamped scale; the paper has many more

    Returns
    -------
    (H, W) float32 in [0, 1], 1 = white

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and positive or zero, and knobs out of range.

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
    state = steps.last(
        tonemap_steps(divide_by_median(L), headroom=headroom, sigma=sigma, passes=passes)
    )
    return np.clip(state.Ld, 0, 1)
