"""A pixel is shared between the two bins whose middles it lies between."""

import numpy as np


def decode(P):
    return np.where(P <= 0.04045, P / 12.92, ((np.maximum(P, 0) + 0.055) / 1.055) ** 2.4)


def equalise(L, *, bins=1024, limit=4.0):
    low, high = np.partition(L.ravel(), [1, L.size - 2])[[1, L.size - 2]].astype(float)
    widen = np.sqrt(max(1, 2 * low / high))
    low, high = low / widen, high * widen
    t = (np.log(L) - np.log(low)) / np.log(high / low) * bins
    m = np.clip(t - 0.5, 0, bins - 1)
    i = np.minimum(m.astype(int), bins - 2)
    h = np.zeros(bins)
    np.add.at(h, i, 1 - (m - i))
    np.add.at(h, i + 1, m - i)
    h /= L.size
    c = np.minimum(h, limit / bins)
    r = limit / bins - c
    h = c + r * (1 - c.sum()) / max(r.sum(), 1e-12)
    return np.interp(t, np.arange(bins + 1), decode(np.append(0, np.cumsum(h))))
