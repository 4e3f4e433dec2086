"""Each pixel of b adds the whole of a, at its place."""

import numpy as np
from scipy.ndimage import gaussian_filter


def correlation(X):
    X = np.asarray(X, np.float64)
    kept = X == X
    zero = np.where(kept, X, 0.0)
    mean = gaussian_filter(zero, (0, 4, 4)) / gaussian_filter(kept * 1.0, (0, 4, 4))
    a, b = np.where(kept, zero - mean, 0.0)
    h, w = a.shape
    c = np.zeros((2 * h - 1, 2 * w - 1))
    for y in range(h):
        for x in range(w):
            c[h - 1 - y : 2 * h - 1 - y, w - 1 - x : 2 * w - 1 - x] += b[y, x] * a
    return c
