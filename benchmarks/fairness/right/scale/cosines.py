"""The Gaussian as a factor on cosine coefficients (mirrored edges, nothing cut off)."""

import numpy as np
from scipy import fft


def scale(L, *, headroom=8.0, sigma=None):
    L = np.asarray(L, np.float64)
    H, W = L.shape
    if sigma is None:
        sigma = min(H, W) / 10
    wy = np.pi * np.arange(H) / H
    wx = np.pi * np.arange(W) / W
    factor = np.outer(np.exp(-0.5 * (sigma * wy) ** 2), np.exp(-0.5 * (sigma * wx) ** 2))
    blurred = fft.idctn(fft.dctn(L) * factor)
    blurred = np.maximum(blurred, L.min())
    return np.reciprocal(headroom * np.maximum(blurred, np.finfo(float).tiny))
