import numpy as np
from scipy.stats import chi2, f


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    A = np.asarray(A, dtype=np.float64)
    if A.ndim != 3:
        raise ValueError("frames must be (t, H, W)")
    if size < 1 or size % 2 != 1:
        raise ValueError("size must be odd and positive")
    if psi <= 0 or psi >= 1:
        raise ValueError("psi out of range")
    if A.shape[0] == 1 and sigma <= 0:
        raise ValueError("sigma must be positive")
    t, H, W = A.shape
    s = size**2
    r = size // 2
    avg = A.sum(axis=0) / t
    if t > 1:
        seen = ((A - avg) ** 2).sum(axis=0) / (t - 1)
        limit = (s - 1) * f.isf(psi, s - 1, s * (t - 1))
    else:
        limit = chi2.isf(psi, s - 1)
    mask = np.zeros((H, W), dtype=bool)
    for i in range(r, H - r):
        for j in range(r, W - r):
            patch = avg[i - r : i + r + 1, j - r : j + r + 1]
            ss = ((patch - patch.mean()) ** 2).sum() / s
            if t == 1:
                noise = sigma**2
            else:
                noise = seen[i - r : i + r + 1, j - r : j + r + 1].mean() / t
            mask[i, j] = s * ss <= limit * noise
    return mask
