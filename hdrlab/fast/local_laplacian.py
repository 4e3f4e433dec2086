"""Local Laplacian filters, fast: coefficients are used while they are in the cache."""

import numpy as np

from hdrlab.core.arrays import F32
from hdrlab.core.filters.pyramid import depth
from hdrlab.fast import pyramid, with_parts
from hdrlab.tonemap import local_laplacian


def remap(lL: F32, g: float, *, sigma: float, alpha: float, beta: float) -> F32:
    """Return r of the lesson, without computing a power if alpha = 1."""
    if alpha != 1:
        return local_laplacian.remap(lL, g, sigma=sigma, alpha=alpha, beta=beta)
    r = np.clip(lL, g - sigma, g + sigma)
    if not beta:
        return r
    return r + np.float32(beta) * (lL - r)


def filtered(lL: F32, *, sigma: float, alpha: float, beta: float, samples: int) -> F32:
    """Return the filtered image of the lesson, summed in place in bands of rows."""
    G = pyramid.gaussian(lL, depth(lL.shape, 2))
    levels = [*(np.zeros_like(level) for level in G[:-1]), G[-1]]
    darkest = float(lL.min())
    spacing = max(float(np.ptp(lL)) / (samples - 1), 1e-6)
    for j in range(samples):
        g = darkest + spacing * j
        fine = remap(lL, g, sigma=sigma, alpha=alpha, beta=beta)
        for O_k, G_k in zip(levels[:-1], G, strict=False):
            coarse = pyramid.reduce(fine)
            for _, rows, expanded in pyramid._expand_bands(coarse, fine.shape):
                distance = np.abs(G_k[rows] - np.float32(g)) * np.float32(1 / spacing)
                h = np.maximum(1 - distance, 0)
                O_k[rows] += h * (fine[rows] - expanded)
            fine = coarse
    return pyramid.collapse(levels)


tonemap = with_parts(__name__, local_laplacian.tonemap, filtered=filtered)
