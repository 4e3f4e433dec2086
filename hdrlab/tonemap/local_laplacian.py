"""Local Laplacian filters (Paris, Hasinoff, Kautz, SIGGRAPH 2011), fast (Aubry et al., ACM TOG 33(5), 2014).

lL     ln luminance, 0 at white        (H, W); I in the papers
G_k    level k of its Gaussian pyramid
g      a brightness                    nats, one of the values of G_k; g_0 in Paris, gamma in Aubry
r      remapped about g                (H, W), nats
sigma  threshold                       nats: a smaller difference from g is detail, a larger one an edge
alpha  power of details                below 1, details grow
beta   slope of edges                  0 to 1: the part of a difference beyond sigma that is kept
O_k    level k of the output           the coefficients L_k of r, each with g = G_k at its own pixel

Paris et al. remap the picture again for every coefficient. Aubry et al. remap it for a few g, and
interpolate. There is no base layer: an edge is compressed at each scale. The wide shading that
remains next to it changes in the same direction as the edge.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F32, ArrayLike, as_luminance
from hdrlab.core.extremes import robust_maximum, robust_minimum
from hdrlab.core.filters import pyramid
from hdrlab.core.steps import last
from hdrlab.errors import InputError

LAWS = ("exposure",)
# nats, as in the program of Paris et al.
DISPLAY_CONTRAST = 4.6
# fraction of the pixels beyond the display's range at either end, as in their program
CLIPPED_FRACTION = 0.005
# percentiles are computed from about this many pixels
PERCENTILE_PIXELS = 2**18


class Sample(NamedTuple):
    """A brightness g, the picture r (H, W) remapped about it, and the levels O_k of the output so far."""

    g: float
    r: F32
    levels: list[F32]


def log_luminance(L: F32) -> F32:
    """Return lL = ln(L / Lwhite), clipped at 0 and at ln of a millionth.

    0.01 % of the pixels are brighter than Lwhite.
    """
    white = robust_maximum(L)
    black = max(robust_minimum(L), 1e-6 * white)
    return np.log(np.clip(L, black, white) / np.float32(white))


def remap(lL: F32, g: float, *, sigma: float, alpha: float, beta: float) -> F32:
    """Return r = g +- (sigma min(d / sigma, 1)^alpha + beta max(d - sigma, 0)), d = |lL - g| [Paris11]."""
    d = np.abs(lL - g)
    detail = sigma * np.minimum(d / sigma, 1) ** alpha
    edge = beta * np.maximum(d - sigma, 0)
    return g + np.sign(lL - g) * (detail + edge)


def filter_steps(
    lL: F32, *, sigma: float, alpha: float, beta: float, samples: int
) -> Iterator[Sample]:
    """Yield a Sample of each g: O_k += h L_k(r), h = max(1 - |G_k - g| / spacing, 0) [Aubry14]; O_d = G_d."""
    G = pyramid.gaussian(lL, pyramid.depth(lL.shape, 2))
    levels = [np.zeros_like(level) for level in G[:-1]] + G[-1:]
    darkest = float(lL.min())
    spacing = max(float(np.ptp(lL)) / (samples - 1), 1e-6)
    for j in range(samples):
        g = darkest + spacing * j
        r = remap(lL, g, sigma=sigma, alpha=alpha, beta=beta)
        details = pyramid.laplacian(r, len(G))[:-1]
        for k, detail in enumerate(details):
            h = np.maximum(1 - np.abs(G[k] - g) / spacing, 0)
            levels[k] = levels[k] + h * detail
        yield Sample(g, r, levels.copy())


def filtered(lL: F32, *, sigma: float, alpha: float, beta: float, samples: int) -> F32:
    """Return the filtered picture (H, W) in nats, collapsed from its levels O_k."""
    steps = filter_steps(lL, sigma=sigma, alpha=alpha, beta=beta, samples=samples)
    return pyramid.collapse(last(steps).levels)


def tonemap(
    L: ArrayLike, *, sigma: float = 0.92, alpha: float = 1.0, beta: float = 0.0, samples: int = 24
) -> F32:
    """Return display luminance with compressed edges at all scales, and details kept or amplified.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    sigma : a smaller difference is detail, nats, at least 0.01; ln 2.5 in the paper
    alpha : power of details, above 0; below about 0.7, more samples are needed
    beta : the part of an edge beyond sigma that is kept, 0 to 1
    samples : number of brightnesses g, at least 2; they should be at most about sigma / 2 apart

    Returns
    -------
    (H, W) float32 in [0, 1], 1 = white

    Raises
    ------
    ValueError
        For luminance that is not (H, W), finite and at least 0, and parameters out of range.

    Examples
    --------
    >>> L = np.where(np.arange(64) < 32, 1.0, 10000.0) * np.ones((64, 1))
    >>> bool(tonemap(L)[32, 10] > 50 / 10000)
    True
    """
    L = as_luminance(L)
    if not (0.01 <= sigma < np.inf and 0 < alpha < np.inf and 0 <= beta <= 1 and samples >= 2):
        raise InputError(
            "expected sigma >= 0.01, alpha > 0, beta in 0 ... 1, samples >= 2, "
            f"got {sigma=}, {alpha=}, {beta=}, {samples=}"
        )
    if L.max() == 0:
        return np.zeros_like(L)
    lLd = filtered(log_luminance(L), sigma=sigma, alpha=alpha, beta=beta, samples=samples)
    every = 1 + lLd.size // PERCENTILE_PIXELS
    percentiles = [CLIPPED_FRACTION, 1 - CLIPPED_FRACTION]
    low, high = np.quantile(lLd.ravel()[::every], percentiles).tolist()
    compression = min(1.0, DISPLAY_CONTRAST / max(high - low, 1e-6))
    return np.minimum(np.exp(compression * (lLd - high)), 1)
