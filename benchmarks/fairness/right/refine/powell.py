"""Powell's method, an interpolator object, and homogeneous matrices."""

import numpy as np
from scipy.interpolate import RegularGridInterpolator
from scipy.optimize import minimize


def refine(X, start, *, reach=1.0):
    h, w = X.shape[1:]
    r = 0.5 * (h * h + w * w) ** 0.5
    look = RegularGridInterpolator(
        (np.arange(h), np.arange(w)), X[1].astype(float), bounds_error=False, fill_value=np.nan
    )
    to_middle = np.array([[1, 0, -(w - 1) / 2], [0, 1, -(h - 1) / 2], [0, 0, 1]])
    p = np.array([(c, k, 1) for k in range(h) for c in range(w)], float).T
    a = X[0].ravel().astype(float)

    def e(m):
        s, c = np.sin(m[2] / r), np.cos(m[2] / r)
        turn = np.array([[c, -s, m[1]], [s, c, m[0]], [0, 0, 1]])
        H = np.linalg.inv(to_middle) @ turn @ to_middle
        q = np.linalg.solve(H, p)
        b = look(q[1::-1].T)
        ok = ~np.isnan(a + b)
        d = 2 * (a - b)[ok] / (a + b)[ok]
        return d.dot(d) / len(d)

    return minimize(e, np.array(start, float), method="Powell").x.tolist()
