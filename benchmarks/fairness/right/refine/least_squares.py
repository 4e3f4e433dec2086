"""Gauss and Newton instead of a simplex."""

import numpy as np
from scipy import ndimage, optimize


def refine(X, start, *, reach=1.0):
    h, w = X.shape[1:]
    r = np.sqrt(h**2 + w**2) / 2
    middle = np.array([h - 1, w - 1]) / 2
    p = np.indices((h, w)).reshape(2, -1).T - middle

    def d(m):
        s, c = np.sin(m[2] / r), np.cos(m[2] / r)
        back = np.array([[c, -s], [s, c]])  # of (y, x)
        q = (p - m[:2]) @ back.T + middle
        b = ndimage.map_coordinates(X[1].astype(float), q.T, order=1, cval=np.nan)
        a = X[0].ravel()
        out = 2 * (a - b) / (a + b)
        good = np.isfinite(out)
        return np.where(good, out, 0) / np.sqrt(good.sum())

    def slopes(m):
        return np.stack([d(m + s) - d(m - s) for s in 0.2 * np.eye(3)], axis=1) / 0.4

    return optimize.least_squares(d, np.asarray(start, float), slopes).x
