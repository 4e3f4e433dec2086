"""Local Laplacian filters (Paris, Hasinoff, Kautz, SIGGRAPH 2011), fast (Aubry et al., ACM TOG 33(5), 2014).

lL     ln luminance, 0 at white        (H, W); I in the papers
G_k    level k of its Gaussian pyramid
g      a brightness                    nats: what G_k may be somewhere; g_0 in Paris, gamma in Aubry
r      remapped about g                (H, W), nats
sigma  what differs from g by less is detail, and by more an edge, nats
alpha  power of details, below 1 they grow; beta, what is left of edges beyond sigma, 0 to 1
O_k    level k of the answer           the coefficients L_k of r, each with g = G_k at its own place

Paris et al. remap the picture anew for every coefficient, Aubry et al. for a few g, and
interpolate. There is no base: an edge is made smaller at each scale, and the wide shade left beside
it runs the way the edge does.
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
# of the display, nats, and the fraction of pixels beyond it at either end: those of Paris's program
CONTRAST, CUT = 4.6, 0.005


class Sample(NamedTuple):
    """One more g, the picture remapped about it, r (H, W), and the levels O_k of the answer so far."""

    g: float
    r: F32
    levels: list[F32]


def log_luminance(L: F32) -> F32:
    """Return lL = ln(L / Lwhite), cut at Lwhite, the brightest but for 0.01 %, and at its millionth."""
    white = robust_maximum(L)
    return np.log(np.clip(L, max(robust_minimum(L), 1e-6 * white), white) / np.float32(white))


def remap(lL: F32, g: float, *, sigma: float, alpha: float, beta: float) -> F32:
    """Return r = g +- (sigma min(d / sigma, 1)^alpha + beta max(d - sigma, 0)), d = |lL - g| [Paris11]."""
    d = np.abs(lL - g)
    detail, edge = sigma * np.minimum(d / sigma, 1) ** alpha, beta * np.maximum(d - sigma, 0)
    return g + np.sign(lL - g) * (detail + edge)


def filter_steps(
    lL: F32, *, sigma: float, alpha: float, beta: float, samples: int
) -> Iterator[Sample]:
    """Yield a Sample of each g: O_k += h L_k(r), h = max(1 - |G_k - g| / spacing, 0) [Aubry14]; O_d = G_d."""
    G = pyramid.gaussian(lL, pyramid.depth(lL.shape, 2))
    levels = [np.zeros_like(level) for level in G[:-1]] + G[-1:]
    spacing = max(float(np.ptp(lL)) / (samples - 1), 1e-6)
    for g in (float(lL.min()) + spacing * j for j in range(samples)):
        r = remap(lL, g, sigma=sigma, alpha=alpha, beta=beta)
        for k, detail in enumerate(pyramid.laplacian(r, len(G))[:-1]):
            levels[k] = levels[k] + np.maximum(1 - np.abs(G[k] - g) / spacing, 0) * detail
        yield Sample(g, r, levels.copy())


def filtered(lL: F32, *, sigma: float, alpha: float, beta: float, samples: int) -> F32:
    """Return the answer, (H, W) in nats: its levels O_k, collapsed."""
    steps = filter_steps(lL, sigma=sigma, alpha=alpha, beta=beta, samples=samples)
    return pyramid.collapse(last(steps).levels)


def tonemap(
    L: ArrayLike, *, sigma: float = 0.92, alpha: float = 1.0, beta: float = 0.0, samples: int = 24
) -> F32:
    """Return display luminance with edges made smaller at all scales, and details kept or raised.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    sigma : what differs by less is detail, nats, at least 0.01; ln 2.5 in the paper
    alpha : power of details, above 0; below 0.7 or so more samples are needed
    beta : what is left of edges, 0 to 1
    samples : number of brightnesses g, at least 2, about sigma / 2 apart or less

    Returns
    -------
    (H, W) float32 in [0, 1], 1 = white

    Raises
    ------
    ValueError : for luminance that is not (H, W), finite and positive or zero, and knobs out of
        range

    Examples
    --------
    >>> L = np.where(np.arange(64) < 32, 1.0, 10000.0) * np.ones((64, 1))
    >>> bool(tonemap(L)[32, 10] > 50 / 10000)
    True
    """
    L = as_luminance(L)
    if not (0.01 <= sigma < np.inf and 0 < alpha < np.inf and 0 <= beta <= 1 and samples >= 2):
        raise InputError(f"expected knobs in range, got {sigma=}, {alpha=}, {beta=}, {samples=}")
    if L.max() == 0:
        return np.zeros_like(L)
    lLd = filtered(log_luminance(L), sigma=sigma, alpha=alpha, beta=beta, samples=samples)
    low, high = np.quantile(lLd.ravel()[:: 1 + lLd.size // 2**18], [CUT, 1 - CUT]).tolist()
    return np.minimum(np.exp(min(1.0, CONTRAST / max(high - low, 1e-6)) * (lLd - high)), 1)
