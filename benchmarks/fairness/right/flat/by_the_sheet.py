"""As the sheet says."""

import numpy as np
from scipy.ndimage import uniform_filter
from scipy.stats import chi2, f


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    t, s = len(A), size**2
    mean = A.mean(axis=0)
    spread = uniform_filter(mean**2, size) - uniform_filter(mean, size) ** 2
    if t == 1:
        good = s * spread / sigma**2 <= chi2.isf(psi, s - 1)
    else:
        noise = uniform_filter(A.var(axis=0, ddof=1), size)
        good = s * spread / (noise / t) <= (s - 1) * f.isf(psi, s - 1, s * (t - 1))
    border = size // 2
    mask = np.zeros(mean.shape, bool)
    mask[border:-border, border:-border] = good[border:-border, border:-border]
    return mask
