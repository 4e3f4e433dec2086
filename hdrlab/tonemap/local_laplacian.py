"""Local Laplacian filters (Paris, Hasinoff, Kautz, SIGGRAPH 2011), fast (Aubry et al., ACM TOG 33(5), 2014).

lL     ln luminance, 0 at white        (H, W); I in the papers
G_k    level k of its Gaussian pyramid
g      a brightness                    nats, one of the values of G_k; g_0 in Paris, gamma in Aubry
r      remapped about g                (H, W), nats
sigma  threshold                       nats: a smaller difference from g is detail, a larger one an edge
alpha  power of details                below 1, details grow
beta   slope of edges                  0 to 1: the part of a difference beyond sigma that is kept
tau    weight of the power             0 for differences as small as noise, 1 for larger ones
O_k    level k of the output           the coefficients L_k of r, each with g = G_k at its own pixel

Paris et al. remap the picture again for every coefficient. Aubry et al. remap it for a few g, and
interpolate. There is no base layer: an edge is compressed at each scale. The wide shading that
remains next to it changes in the same direction as the edge.

With alpha < 1, the slope of the power d^alpha is infinite at d = 0, so it would amplify noise most of
all. Differences up to 0.01 nats, a contrast of 1 %, therefore stay as they are (Paris et al., section
on noise, and their program). Noise that is larger is amplified like any other detail.
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
# nats, as in their program: a difference up to this is noise, from twice this on it is detail
NOISE_NATS = 0.01
# fewest brightnesses g
MIN_SAMPLES = 2
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


def detail_weight(d: F32) -> F32:
    """Return tau = y^2 (2 - y)^2, y = d / 0.01 - 1 between 0 and 1: a smooth step from noise to detail."""
    y = np.clip(d / NOISE_NATS - 1, 0, 1)
    return y**2 * (2 - y) ** 2


def remap(lL: F32, g: float, *, sigma: float, alpha: float, beta: float) -> F32:
    """Return r = g +- (sigma f(min(d / sigma, 1)) + beta max(d - sigma, 0)), d = |lL - g| [Paris11].

    f(x) = x^alpha. For alpha < 1, f(x) = tau x^alpha + (1 - tau) x, with tau of `detail_weight`: a
    power below 1 would amplify noise most of all.

    Examples
    --------
    >>> r = remap(np.array([0.01, 0.25]), 0.0, sigma=1.0, alpha=0.5, beta=0.0)  # noise, and a detail
    >>> r.tolist()
    [0.01, 0.5]
    """
    d = np.abs(lL - g)
    x = np.minimum(d / sigma, 1)
    f = x**alpha
    if alpha < 1:
        tau = detail_weight(d)
        f = tau * f + (1 - tau) * x
    return g + np.sign(lL - g) * (sigma * f + beta * np.maximum(d - sigma, 0))


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


def samples_needed(lL: F32, sigma: float) -> int:
    """Return how many brightnesses g are at most sigma / 2 apart over the range of a picture.

    Examples
    --------
    >>> samples_needed(np.array([-9.2, 0.0]), sigma=0.92)  # four decades of light
    21
    """
    intervals = np.ceil(float(np.ptp(lL)) / (sigma / 2) - 1e-6)
    return max(MIN_SAMPLES, 1 + int(intervals))


def tonemap(
    L: ArrayLike,
    *,
    sigma: float = 0.92,
    alpha: float = 1.0,
    beta: float = 0.0,
    samples: int | None = None,
) -> F32:
    """Return display luminance with compressed edges at all scales, and details kept or amplified.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    sigma : a smaller difference is detail, nats, at least 0.01; ln 2.5 in the paper
    alpha : power of details, above 0; below 1 it amplifies details above 1 % contrast, with all noise
        that is as large; below about 0.7, more samples are needed
    beta : the part of an edge beyond sigma that is kept, 0 to 1
    samples : number of brightnesses g, at least 2; None for as many as are sigma / 2 apart

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
    in_range = 0.01 <= sigma < np.inf and 0 < alpha < np.inf and 0 <= beta <= 1
    if not in_range or (samples is not None and samples < MIN_SAMPLES):
        raise InputError(
            "expected sigma >= 0.01, alpha > 0, beta in 0 ... 1, samples >= 2, "
            f"got {sigma=}, {alpha=}, {beta=}, {samples=}"
        )
    if L.max() == 0:
        return np.zeros_like(L)
    lL = log_luminance(L)
    if samples is None:
        samples = samples_needed(lL, sigma)
    lLd = filtered(lL, sigma=sigma, alpha=alpha, beta=beta, samples=samples)
    every = 1 + lLd.size // PERCENTILE_PIXELS
    percentiles = [CLIPPED_FRACTION, 1 - CLIPPED_FRACTION]
    low, high = np.quantile(lLd.ravel()[::every], percentiles).tolist()
    compression = min(1.0, DISPLAY_CONTRAST / max(high - low, 1e-6))
    return np.minimum(np.exp(compression * (lLd - high)), 1)
