import numpy as np
from scipy import stats
from scipy.ndimage import uniform_filter


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    A = np.asarray(A, dtype=np.float64)
    if A.ndim != 3:
        raise ValueError(f"frames must be (t, H, W), not {A.shape}")
    if size % 2 == 0 or size < 3:
        raise ValueError(f"size {size} must be odd and at least 3")
    if not (0 < psi < 1):
        raise ValueError(f"psi {psi} must be in (0, 1)")
    if not (sigma > 0 and np.isfinite(sigma)):
        raise ValueError(f"sigma {sigma} must be positive")
    t = len(A)
    s = size * size
    avg = A.mean(0)
    c = avg - avg.mean()
    ss = np.maximum(uniform_filter(c * c, size) - uniform_filter(c, size) ** 2, 0)
    if t == 1:
        noise = np.full(avg.shape, sigma**2)
        limit = stats.chi2.isf(psi, s - 1)
    else:
        noise = uniform_filter(A.var(0) * t / (t - 1), size) / t
        limit = (s - 1) * stats.f.isf(psi, s - 1, s * (t - 1))
    out = np.zeros(avg.shape, dtype=int)
    r = size // 2
    inner = (slice(r, avg.shape[0] - r), slice(r, avg.shape[1] - r))
    if min(avg.shape) >= size:
        out[inner] = (s * ss <= limit * noise)[inner]
    return out
