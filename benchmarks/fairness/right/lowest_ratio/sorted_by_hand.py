"""Sorted, and a straight line between neighbors in rank."""

import numpy as np


def lowest_ratio(F, G):
    r = np.sort((F.astype(float)[G > 0] / G.astype(float)[G > 0]).ravel())
    n = r.size
    if n < 5000:
        return [0.0, np.inf]

    def at(p):
        k = p * (n - 1)
        i = int(k)
        return r[i] + (k - i) * (r[i + 1] - r[i])

    low = at(2e-4)
    return [max(2 * low - at(1e-3), 0.0), at(1e-2) / low]
