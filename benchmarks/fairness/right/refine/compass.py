"""One number after the other, with smaller and smaller steps."""

import numpy as np
from scipy import ndimage


def refine(X, start, *, reach=1.0):
    h, w = X.shape[1:]
    r = np.hypot(h, w) / 2
    y, x = np.indices((h, w))
    z = (x - (w - 1) / 2) + 1j * (y - (h - 1) / 2)

    def e(m):
        q = (z - complex(m[1], m[0])) * np.exp(-1j * m[2] / r)
        at = [q.imag + (h - 1) / 2, q.real + (w - 1) / 2]
        b = ndimage.map_coordinates(X[1], at, order=1, mode="constant", cval=np.nan)
        d = (X[0] - b) / ((X[0] + b) / 2)
        return float(np.mean(d[np.isfinite(d)] ** 2))

    m, step = np.array(start, dtype=float), 1.0
    best = e(m)
    while step > 0.004:
        better = False
        for k in range(3):
            for sign in (1, -1):
                other = m.copy()
                other[k] += sign * step
                value = e(other)
                if value < best:
                    m, best, better = other, value, True
        if not better:
            step /= 2
    return tuple(m)
