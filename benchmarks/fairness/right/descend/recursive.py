"""Each value and the series that follows from it."""

import numpy as np


def descend(T, start, *, low=12.0):
    z = np.arange(len(T))[np.isfinite(T)]

    def below(m):
        if m < z[0] or m > z[-1]:
            return []
        t = np.interp(m, z, T[z])
        return [t, *below(t)] if low <= t <= m - 0.5 else []

    return np.array([start, *below(start)], dtype=float)
