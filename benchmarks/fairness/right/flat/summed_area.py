import numpy as np
from scipy import stats


def _box(a, n):
    c = np.zeros((a.shape[0] + 1, a.shape[1] + 1))
    c[1:, 1:] = a.cumsum(0).cumsum(1)
    return c[n:, n:] - c[:-n, n:] - c[n:, :-n] + c[:-n, :-n]


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    A = np.asarray(A, dtype=np.float64)
    if A.ndim != 3 or A.size == 0:
        raise ValueError("A is (t, H, W)")
    if size < 3 or size % 2 != 1 or not 0 < psi < 1 or not sigma > 0:
        raise ValueError("size is odd, 0 < psi < 1, sigma > 0")
    t, H, W = A.shape
    s, r = size**2, size // 2
    mask = np.zeros((H, W), dtype=bool)
    if min(H, W) < size:
        return mask
    avg = A.mean(axis=0)
    d = avg - avg.mean()
    ssq = _box(d * d, size) - _box(d, size) ** 2 / s
    if t == 1:
        bound = stats.chi2.isf(psi, s - 1) * sigma**2
    else:
        per = np.sum((A - avg) ** 2, axis=0) / (t - 1)
        bound = _box(per, size) / s / t * (s - 1) * stats.f.isf(psi, s - 1, s * (t - 1))
    mask[r : H - r, r : W - r] = ssq <= bound
    return mask
