"""Local Laplacian filters, fast: no coefficient leaves the cache before its share of the answer is taken."""

import numpy as np

from hdrlab.core.arrays import F32
from hdrlab.core.filters.pyramid import depth
from hdrlab.fast import pyramid, with_parts
from hdrlab.tonemap import local_laplacian


def remap(lL: F32, g: float, *, sigma: float, alpha: float, beta: float) -> F32:
    """Return the lesson's r, for alpha = 1 without its powers: near g it is lL itself."""
    if alpha != 1:
        return local_laplacian.remap(lL, g, sigma=sigma, alpha=alpha, beta=beta)
    r = np.clip(lL, g - sigma, g + sigma)
    return r + np.float32(beta) * (lL - r) if beta else r


def filtered(lL: F32, *, sigma: float, alpha: float, beta: float, samples: int) -> F32:
    """Return the lesson's answer; its levels grow in place, a band of rows at a time."""
    G = pyramid.gaussian(lL, depth(lL.shape, 2))
    levels = [np.zeros_like(level) for level in G[:-1]] + G[-1:]
    spacing = max(float(np.ptp(lL)) / (samples - 1), 1e-6)
    for g in (float(lL.min()) + spacing * j for j in range(samples)):
        fine = remap(lL, g, sigma=sigma, alpha=alpha, beta=beta)
        for O_k, G_k in zip(levels[:-1], G, strict=False):
            coarse = pyramid.reduce(fine)
            for _, rows, expanded in pyramid._finer(coarse, fine.shape):
                h = np.maximum(1 - np.abs(G_k[rows] - np.float32(g)) * np.float32(1 / spacing), 0)
                O_k[rows] += h * (fine[rows] - expanded)
            fine = coarse
    return pyramid.collapse(levels)


tonemap = with_parts(__name__, local_laplacian.tonemap, filtered=filtered)
