"""In color, the function calls itself with the other colors full."""

import numpy as np
from scipy.ndimage import gaussian_filter


def reconstruct(Z, e, c=None, *, sigma=0.5, full_well=np.inf, read_noise=0.0):
    if c is not None:
        knobs = {"sigma": sigma, "full_well": full_well, "read_noise": read_noise}
        maps = [reconstruct(np.where(c == k, Z, 255), e, **knobs) for k in range(3)]
        return np.stack(maps, axis=2)
    measured = Z <= 253
    X = Z / 255
    variance = (X / full_well + (read_noise / full_well) ** 2 + 1 / (12 * 255**2)) / e**2
    w = measured / variance
    return gaussian_filter(w * (X / e), sigma) / np.maximum(gaussian_filter(w, sigma), 1e-200)
