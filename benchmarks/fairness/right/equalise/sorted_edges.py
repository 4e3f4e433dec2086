"""The fractions below the edges by searchsorted."""

import numpy as np


def equalise(L, *, bins=1024, limit=4.0):
    x = np.log(L.astype(np.float64))
    s = np.sort(x.ravel())
    low, high = s[1], s[-2]
    half = max(np.log(2) - (high - low), 0) / 2
    edges = np.linspace(low - half, high + half, bins + 1)
    below = np.searchsorted(s, edges, side="left") / s.size
    below[0], below[-1] = 0, 1
    h = np.diff(below)
    t = limit / bins
    cut = np.where(h > t, t, h)
    free = t * bins - cut.sum()
    if free > 1e-12:
        cut = t - (t - cut) * (t * bins - 1) / free
    P = np.interp(x, edges, np.r_[0, cut.cumsum()])
    linear = P / 12.92
    power = np.power((P + 0.055) / 1.055, 2.4)
    return np.where(P > 0.04045, power, linear)
