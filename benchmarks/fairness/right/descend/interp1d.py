"""scipy's interpolation, which is NaN outside of the known values."""

import numpy as np
from scipy.interpolate import interp1d


def descend(T, start, low=12.0):
    ok = np.isfinite(T)
    line = interp1d(np.flatnonzero(ok), T[ok], bounds_error=False, fill_value=np.nan)
    series = np.array([start])
    while True:
        m = line(series[-1])
        if not (m >= low and series[-1] - m >= 0.5):
            return series
        series = np.append(series, m)
