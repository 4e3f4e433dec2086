import numpy as np
from scipy import stats
from scipy.signal import convolve2d


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    """The same asked the other way round: chance that noise alone is as large, at least psi."""
    A = np.asarray(A, dtype=float)
    if A.ndim != 3:
        raise ValueError("frames (t, H, W)")
    if size < 3 or not size % 2:
        raise ValueError("size")
    if not 0 < psi < 1:
        raise ValueError("psi")
    if not sigma > 0:
        raise ValueError("sigma")
    t, H, W = A.shape
    s, r = size * size, size // 2
    out = np.zeros((H, W))
    if min(H, W) < size:
        return out
    box = np.ones((size, size)) / s
    avg = A.mean(0)
    avg = avg - np.median(avg)
    ss = np.maximum(convolve2d(avg**2, box, "valid") - convolve2d(avg, box, "valid") ** 2, 0)
    if t == 1:
        p = stats.chi2.sf(s * ss / sigma**2, s - 1)
    else:
        st = convolve2d(A.var(0, ddof=1), box, "valid")
        top, bottom = s * ss / (s - 1), st / t
        q = np.where(
            bottom > 0, top / np.where(bottom > 0, bottom, 1), np.where(top > 0, np.inf, 0)
        )
        p = stats.f.sf(q, s - 1, s * (t - 1))
    out[r : H - r, r : W - r] = p >= psi
    return out
