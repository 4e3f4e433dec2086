import numpy as np
from scipy import stats


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    """Shifted copies; the average kept in float32, the squares of differences from each patch's mean."""
    A = np.asarray(A)
    if A.ndim != 3 or A.shape[0] < 1:
        raise ValueError("A must be (t, H, W)")
    if size <= 0 or size % 2 == 0:
        raise ValueError("size must be odd")
    if not 0 < psi < 1:
        raise ValueError("0 < psi < 1")
    if sigma < 0:
        raise ValueError("sigma must not be negative")
    t, H, W = A.shape
    s = size * size
    out = np.zeros((H, W), dtype=bool)
    h, w = H - size + 1, W - size + 1
    if h < 1 or w < 1:
        return out
    avg = A.mean(axis=0, dtype=np.float64).astype(np.float32)

    def parts(a):
        return [a[i : i + h, j : j + w] for i in range(size) for j in range(size)]

    m = sum(parts(avg)) / np.float32(s)
    sq = sum((q - m) ** 2 for q in parts(avg))
    if t == 1:
        limit = stats.chi2.isf(psi, s - 1) * sigma * sigma
    else:
        v = A.astype(np.float64).var(axis=0, ddof=1)
        limit = (s - 1) * stats.f.isf(psi, s - 1, s * (t - 1)) * (sum(parts(v)) / s) / t
    r = size // 2
    out[r : r + h, r : r + w] = sq <= limit
    return out
