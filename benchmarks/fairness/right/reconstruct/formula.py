"""The sheet's quotient, one color after the other."""

import numpy as np
from scipy.ndimage import gaussian_filter


def reconstruct(Z, e, c=None, *, sigma=0.5, full_well=np.inf, read_noise=0.0):
    X = Z / 255
    w = e**2 / (X / full_well + (read_noise / full_well) ** 2 + 1 / (12 * 255**2))
    w[X >= 0.995] = 0

    def mean(w):
        return gaussian_filter(w * X / e, sigma) / gaussian_filter(w, sigma)

    if c is None:
        return mean(w)
    return np.stack([mean(w * (c == k)) for k in range(3)], axis=-1)
