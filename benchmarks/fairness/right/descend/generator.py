"""The values are yielded by a helper."""

import numpy as np


def values(T, m, low):
    first, last = np.nonzero(T == T)[0][[0, -1]]
    yield m
    while first <= m <= last:
        i = min(int(m), len(T) - 2)
        if i == last:
            t = T[last]
        else:
            t = T[i] + (T[i + 1] - T[i]) * (m - i)
        if t < low or t > m - 0.5:
            return
        m = t
        yield m


def descend(T, start, *, low=12.0):
    return np.fromiter(values(np.asarray(T, float), float(start), low), float)
