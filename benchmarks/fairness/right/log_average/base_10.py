"""Base 10."""

import numpy as np


def log_average(L, *, delta=1e-6):
    lit = np.sort(L[L > 0].astype(float))
    return 10 ** np.log10(L.astype(float) + delta * lit[len(lit) // 2]).mean()
