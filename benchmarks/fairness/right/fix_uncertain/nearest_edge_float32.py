import numpy as np
from scipy import ndimage


def fix_uncertain(mean, k, *, sigma_s):
    mean = np.asarray(mean, dtype=np.float32)
    k = np.asarray(k, dtype=np.float32)
    u = 2 * np.log(k) / np.float32(np.log(2 * np.pi * sigma_s * sigma_s))
    u = np.minimum(np.maximum(u, 0), 1).astype(np.float32)
    soft = ndimage.gaussian_filter(mean, 2.0, mode="nearest", truncate=5.0)
    return (soft + u * (mean - soft)).astype(np.float32)
