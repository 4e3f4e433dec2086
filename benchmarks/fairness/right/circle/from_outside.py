"""From the corner inwards, while rings differ; a ring alone is skipped."""

import numpy as np


def circle(A, B, tolerance=1.0, rings=40):
    h, w = A.shape
    y, x = np.ogrid[:h, :w]
    r = ((y - (h - 1) / 2) ** 2 + (x - (w - 1) / 2) ** 2) ** 0.5
    outer = float(r.max())
    a, b = A.astype(float), B.astype(float)
    ok = (abs(a - 127) < 123) & (abs(b - 127) < 123)
    near = ok & (r < outer / 4)
    z = np.arange(256)
    n = np.array([np.sum(near & (a == v)) for v in z])
    T = np.array([b[near & (a == v)].mean() if n[v] else 0 for v in z])
    off = b - np.interp(a, z[n > 0], T[n > 0])
    ok &= (a >= z[n > 0].min()) & (a <= z[n > 0].max())
    edge = [outer / 4 + 0.75 * outer * i / rings for i in range(rings + 1)]
    bad = [
        bool(np.any(m := ok & (r >= edge[i]) & (r < edge[i + 1])))
        and abs(np.median(off[m])) > tolerance
        for i in range(rings)
    ]
    end = outer
    for i in reversed(range(rings)):
        if bad[i] and (i == rings - 1 or bad[i + 1]):
            end = edge[i]
    return np.float32(end)
