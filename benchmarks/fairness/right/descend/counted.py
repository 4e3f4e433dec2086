"""A for loop of at most 1000 steps, with left and right NaN in numpy.interp; float32 at the end."""

import numpy as np


def descend(T, start, *, low=12.0):
    known = np.isfinite(T)
    z = np.arange(T.size)[known]
    series = [start]
    for _ in range(1000):
        now = series[-1]
        new = np.interp(now, z, T[known], left=np.nan, right=np.nan)
        if np.isnan(new) or new < low or now - new < 0.5:
            break
        series += [new]
    return np.asarray(series, dtype=np.float32)
