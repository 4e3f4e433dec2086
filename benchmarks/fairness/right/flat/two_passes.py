"""Differences from the local mean, offset by offset; the border by indices."""

import numpy as np
from scipy import stats


def flat(A, *, size=5, psi=0.05, sigma=0.01):
    t, H, W = A.shape
    r, s = size // 2, size**2
    average = A.mean(axis=0)
    offsets = [(dy, dx) for dy in range(-r, r + 1) for dx in range(-r, r + 1)]
    moved = np.array([np.roll(average, one, axis=(0, 1)) for one in offsets])
    spread = ((moved - moved.mean(axis=0)) ** 2).mean(axis=0)
    if t > 1:
        single = A.var(axis=0, ddof=1)
        noise = sum(np.roll(single, one, axis=(0, 1)) for one in offsets) / s
        top = (s - 1) * stats.f.isf(psi, s - 1, s * (t - 1))
    else:
        noise, top = sigma**2, stats.chi2.isf(psi, s - 1)
    y, x = np.indices((H, W))
    inside = (y >= r) & (y < H - r) & (x >= r) & (x < W - r)
    return inside & (s * spread / (noise / t) <= top)
