"""Sums of 'is darker' instead of medians: more than half of a ring is off to one side."""

import numpy as np


def circle(A, B, tolerance=1.0, rings=40):
    h, w = A.shape
    r = np.hypot(np.arange(h)[:, None] - (h - 1) / 2, np.arange(w)[None] - (w - 1) / 2)
    R = r.max()
    a, b = A.astype(int), B.astype(float)
    ok = (a > 4) & (a < 250) & (b > 4) & (b < 250)
    near = ok & (r < R / 4)
    n = np.bincount(a[near], minlength=256)
    v = np.flatnonzero(n)
    T = np.bincount(a[near], b[near], 256)[v] / n[v]
    ok &= (a >= v[0]) & (a <= v[-1])
    off = b - np.interp(a, v, T)
    ring = np.minimum(((r - R / 4) / (0.75 * R) * rings), rings - 1e-9)
    ring = np.where(ok & (ring >= 0), ring, rings).astype(int).ravel()
    total = np.bincount(ring, minlength=rings + 1)[:rings]
    low = np.bincount(ring, (off < -tolerance).ravel(), rings + 1)[:rings]
    high = np.bincount(ring, (off > tolerance).ravel(), rings + 1)[:rings]
    bad = (np.maximum(low, high) > total / 2) & (total > 0)
    for i in range(rings):
        if bad[i] and bad[min(i + 1, rings - 1)]:
            return R / 4 + i / rings * 0.75 * R
    return R
