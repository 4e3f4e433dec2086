import numpy as np
from scipy.ndimage import gaussian_filter


def fix_uncertain(mean, k, *, sigma_s):
    mean = np.asarray(mean, dtype=float)
    u = np.clip(np.log(k) / np.log(np.sqrt(2 * np.pi * sigma_s**2)), 0, 1)
    return u * mean + (1 - u) * gaussian_filter(mean, 2)
