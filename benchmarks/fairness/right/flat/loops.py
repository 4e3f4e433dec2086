"""Patch by patch."""

import numpy as np
from scipy import stats


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    t, H, W = A.shape
    s, r = size**2, size // 2
    found = np.zeros((H, W))
    limit = stats.chi2.isf(psi, s - 1) if t == 1 else (s - 1) * stats.f.isf(psi, s - 1, s * (t - 1))
    for y in range(r, H - r):
        for x in range(r, W - r):
            patch = A[:, y - r : y + r + 1, x - r : x + r + 1]
            noise = sigma**2 if t == 1 else np.mean(np.var(patch, axis=0, ddof=1))
            average = patch.sum(axis=0) / t
            found[y, x] = s * np.var(average) <= limit * noise / t
    return found
