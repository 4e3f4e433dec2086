"""One logarithm of the quotient 100 F^2 / (T S); plain numbers give a Python float, NaN stays NaN."""

import numpy as np


def ev(F, T, *, S=100.0):
    f_number = np.array(F, dtype=float)
    seconds = np.array(T, dtype=float)
    speed = np.array(S, dtype=float)
    if (f_number <= 0).any() or (seconds <= 0).any() or (speed <= 0).any():
        raise ValueError("f-number, time and ISO speed must be positive")
    stops = np.log2((f_number / seconds) * f_number * (100.0 / speed))
    return float(stops) if stops.ndim == 0 else stops
