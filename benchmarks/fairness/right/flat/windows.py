"""Whole windows alone, and ppf of 1 - psi."""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy import stats


def flat(A, size=5, psi=0.05, sigma=0.01):
    t = A.shape[0]
    s = size * size
    patches = sliding_window_view(np.mean(A, axis=0), (size, size))
    quotient = s * patches.var(axis=(2, 3))
    if t > 1:
        own = sliding_window_view(np.var(A, axis=0, ddof=1), (size, size)).mean(axis=(2, 3))
        limit = (s - 1) * stats.f.ppf(1 - psi, s - 1, s * (t - 1)) * own / t
    else:
        limit = stats.chi2.ppf(1 - psi, s - 1) * sigma**2
    return np.pad(quotient <= limit, size // 2)
