"""Sums of squares by tables of sums, of values less their mean."""

import numpy as np
from scipy.stats import chi2, f


def boxes(a, n):
    S = np.pad(a, ((1, 0), (1, 0))).cumsum(0).cumsum(1)
    return S[n:, n:] - S[:-n, n:] - S[n:, :-n] + S[:-n, :-n]


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    t, s, r = len(A), size**2, size // 2
    mean = A.mean(axis=0)
    a = mean - mean.mean()
    squares = boxes(a * a, size) - boxes(a, size) ** 2 / s
    mask = np.zeros(mean.shape, np.uint8)
    if t == 1:
        good = squares <= sigma**2 * chi2.isf(psi, s - 1)
    else:
        one = boxes(A.var(axis=0, ddof=1), size) / s
        good = squares * t <= one * (s - 1) * f.isf(psi, s - 1, s * (t - 1))
    mask[r : r + good.shape[0], r : r + good.shape[1]] = good
    return mask
