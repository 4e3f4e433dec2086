"""Mean of B for each value of A in the middle; medians of rings."""

import numpy as np


def circle(A, B, tolerance=1.0, rings=40):
    a, b = A.astype(int), B.astype(float)
    h, w = a.shape
    y, x = np.indices(a.shape)
    r = np.hypot(y - (h - 1) / 2, x - (w - 1) / 2)
    ok = (a >= 5) & (a <= 249) & (b >= 5) & (b <= 249)
    middle = ok & (r < r.max() / 4)
    T = np.full(256, np.nan)
    for value in np.unique(a[middle]):
        T[value] = b[middle & (a == value)].mean()
    off = b - T[a]
    edges = np.linspace(r.max() / 4, r.max(), rings + 1)
    before = False
    for i in range(rings):
        ring = off[ok & (r >= edges[i]) & (r <= edges[i + 1])]
        ring = ring[~np.isnan(ring)]
        bad = len(ring) > 0 and abs(np.median(ring)) > tolerance
        if bad and before:
            return edges[i - 1]
        before = bad
    return r.max()
