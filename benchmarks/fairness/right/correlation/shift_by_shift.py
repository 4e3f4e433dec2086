"""The sum at each shift, of the two overlapping parts."""

import numpy as np
from scipy.ndimage import gaussian_filter1d


def blur(x):
    return gaussian_filter1d(gaussian_filter1d(x, 4, axis=0), 4, axis=1)


def correlation(X):
    a, b = [
        np.where(np.isnan(x), 0, x - blur(np.nan_to_num(x)) / blur(1.0 - np.isnan(x))) for x in X
    ]
    h, w = a.shape
    c = np.zeros((2 * h - 1, 2 * w - 1))
    for dy in range(1 - h, h):
        for dx in range(1 - w, w):
            mine = a[max(dy, 0) : h + min(dy, 0), max(dx, 0) : w + min(dx, 0)]
            other = b[max(-dy, 0) : h + min(-dy, 0), max(-dx, 0) : w + min(-dx, 0)]
            c[dy + h - 1, dx + w - 1] = np.sum(mine * other)
    return c
