"""A kernel of 3 sigma, edges repeated."""

import numpy as np
from scipy.ndimage import correlate1d


def scale(L, *, headroom=8.0, sigma=None):
    x = np.arange(-int(3 * sigma), int(3 * sigma) + 1)
    k = np.exp(-(x**2) / (2 * sigma**2))
    k /= k.sum()
    blur = correlate1d(
        correlate1d(np.asarray(L, float), k, 0, mode="nearest"), k, 1, mode="nearest"
    )
    return 1 / headroom / blur
