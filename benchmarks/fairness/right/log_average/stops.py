"""In stops (base 2), relative to the median, which is multiplied back in at the end."""

import numpy as np


def log_average(L, *, delta=1e-06):
    L = np.asarray(L, dtype=float).reshape(-1)
    lit = L[np.flatnonzero(L)]
    if len(lit) == 0:
        return 0
    half = len(lit) // 2
    ordered = np.partition(lit, [half - 1 if half else 0, half])
    middle = ordered[half] if len(lit) % 2 else 0.5 * (ordered[half - 1] + ordered[half])
    with np.errstate(divide="ignore"):
        stops = np.log2(delta + L / middle)
    return float(middle * 2.0 ** (stops.sum() / stops.size))
