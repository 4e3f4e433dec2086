"""u as the logarithm to the base of the root; scipy's own clip of the result."""

import numpy as np
from scipy.signal import fftconvolve


def fix_uncertain(mean, k, *, sigma_s):
    y, x = np.mgrid[-10:11, -10:11]
    disc = np.exp(-(x * x + y * y) / (2 * 2.0**2))
    smooth = fftconvolve(np.pad(mean, 10, mode="edge"), disc / disc.sum(), mode="valid")
    base = (2 * np.pi) ** 0.5 * sigma_s
    u = np.median([np.zeros_like(k), np.log(k) / np.log(base), np.ones_like(k)], axis=0)
    return np.add(u * mean, (1 - u) * smooth)
