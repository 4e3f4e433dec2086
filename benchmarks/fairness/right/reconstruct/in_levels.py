"""The variance in squared pixel values, float32 maps."""

import numpy as np
from scipy import ndimage


def reconstruct(Z, e, c=None, sigma=0.5, full_well=np.inf, read_noise=0.0):
    Z = Z.astype(np.float32)
    gain = 255 / full_well
    var = (Z * gain + (read_noise * gain) ** 2 + 1 / 12) / (e * e)
    w = np.where(Z < 0.995 * 255, 1 / var, 0).astype(np.float32)
    E = Z / (255 * e)
    if c is None:
        masks = [np.ones(Z.shape, np.float32)]
    else:
        masks = [(c == k).astype(np.float32) for k in (0, 1, 2)]
    maps = []
    for m in masks:
        below = ndimage.gaussian_filter(w * m, sigma)
        maps.append(ndimage.gaussian_filter(w * m * E, sigma) / below)
    return maps[0] if c is None else np.dstack(maps)
