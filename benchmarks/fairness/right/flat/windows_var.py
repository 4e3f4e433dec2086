import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy import stats


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    A = np.asarray(A, dtype=float)
    if A.ndim != 3 or 0 in A.shape:
        raise ValueError("A must be (t, H, W)")
    if int(size) != size or size < 3 or size % 2 == 0:
        raise ValueError("size must be odd, 3 or more")
    if not 0 < psi < 1:
        raise ValueError("psi must lie between 0 and 1")
    if not sigma > 0:
        raise ValueError("sigma must be above 0")
    t, H, W = A.shape
    s, r = size * size, size // 2
    out = np.zeros((H, W), bool)
    if H < size or W < size:
        return out
    avg = A.mean(axis=0)
    ss = sliding_window_view(avg, (size, size)).var(axis=(2, 3))
    if t == 1:
        ok = s * ss / sigma**2 <= stats.chi2.isf(psi, s - 1)
    else:
        st = sliding_window_view(A.var(axis=0, ddof=1), (size, size)).mean(axis=(2, 3))
        ok = s * ss <= st / t * (s - 1) * stats.f.isf(psi, s - 1, s * (t - 1))
    out[r : H - r, r : W - r] = ok
    return out
