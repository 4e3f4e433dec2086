import numpy as np
from scipy.signal import fftconvolve


def fix_uncertain(mean, k, *, sigma_s):
    """A 2-D kernel of 21 x 21, zeros past the edge."""
    mean = np.asarray(mean, dtype=float)
    t = np.arange(-10, 11)
    g = np.exp(-(t[:, None] ** 2 + t[None] ** 2) / 8.0)
    g /= g.sum()
    blur = fftconvolve(mean, g, mode="same")
    u = np.clip(np.log2(k) / np.log2(np.sqrt(2 * np.pi * sigma_s**2)), 0.0, 1.0)
    return u * mean + (1.0 - u) * blur
