"""scipy.stats.gmean of what is lifted by delta; in an all black scene the median counts as 1."""

import numpy as np
from scipy import stats


def log_average(L, *, delta=1e-06):
    L = np.ravel(L).astype(float)
    lit = np.compress(L > 0, L)
    middle = np.quantile(lit, 0.5) if lit.size else 1.0
    with np.errstate(divide="ignore"):
        return stats.gmean(L + delta * middle)
