"""affine_transform moves the whole photo; fmin, in single steps of two pixels at first."""

import numpy as np
from scipy.ndimage import affine_transform
from scipy.optimize import fmin


def refine(X, start, *, reach=1.0):
    h, w = X.shape[1:]
    r = np.linalg.norm([h, w]) / 2
    middle = np.array([(h - 1) / 2, (w - 1) / 2])
    fixed, moving = X.astype(np.float64)

    def e(m):
        t = m[2] / r
        back = np.array([[np.cos(t), -np.sin(t)], [np.sin(t), np.cos(t)]])
        offset = middle - back @ (middle + m[:2])
        b = affine_transform(moving, back, offset, order=1, cval=np.nan)
        d = 2 * (fixed - b) / (fixed + b)
        return np.nanmean(d * d)

    corners = np.add(start, 2 * np.eye(4, 3))
    corners[3] = start
    return fmin(e, start, xtol=1e-2, ftol=1e-6, initial_simplex=corners, disp=False)
