"""B is a polynomial of A, fitted in the middle; a half-open sorted array of radii."""

import numpy as np


def circle(A, B, *, tolerance=1.0, rings=40):
    h, w = A.shape
    r = np.hypot(
        *np.meshgrid(np.arange(h) - h / 2 + 0.5, np.arange(w) - w / 2 + 0.5, indexing="ij")
    )
    outer = r.max()
    ok = (np.minimum(A, B) > 4) & (np.maximum(A, B) < 250)
    near = ok & (r < outer / 4)
    a, b = A[near] / 255, B[near] / 255
    p = np.polyfit(a, b, 5)
    ok &= (A / 255 >= a.min()) & (A / 255 <= a.max())
    off = 255 * (B / 255 - np.polyval(p, A / 255))
    k = np.floor((r - outer / 4) / (0.75 * outer) * rings).astype(int)
    k = np.minimum(k, rings - 1)
    bad = []
    for i in range(rings):
        ring = off[ok & (k == i)]
        bad.append(ring.size > 0 and abs(np.median(ring)) > tolerance)
    bad.append(bad[-1])
    for i in range(rings):
        if bad[i] and bad[i + 1]:
            return outer / 4 + 0.75 * outer * i / rings
    return outer
