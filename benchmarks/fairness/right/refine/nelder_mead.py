"""scipy's Nelder-Mead on map_coordinates."""

import numpy as np
from scipy import ndimage, optimize


def refine(X, start, *, reach=1.0):
    h, w = X.shape[1:]
    r = np.hypot(h, w) / 2
    y, x = np.mgrid[:h, :w]
    cy, cx = (h - 1) / 2, (w - 1) / 2

    def e(m):
        dy, dx, phi = m[0], m[1], m[2] / r
        u, v = x - cx - dx, y - cy - dy
        qx = np.cos(phi) * u + np.sin(phi) * v + cx
        qy = -np.sin(phi) * u + np.cos(phi) * v + cy
        b = ndimage.map_coordinates(X[1], [qy, qx], order=1, cval=np.nan)
        return np.nanmean(((X[0] - b) / ((X[0] + b) / 2)) ** 2)

    corners = [start, *(start + reach * np.eye(3))]
    return optimize.minimize(e, start, method="Nelder-Mead", options={"initial_simplex": corners}).x
