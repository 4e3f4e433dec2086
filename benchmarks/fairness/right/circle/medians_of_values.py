"""The median of B for each value of A, with straight lines between; loops over pixels sorted by radius."""

import numpy as np


def circle(A, B, tolerance=1.0, rings=40):
    h, w = A.shape
    y, x = np.mgrid[:h, :w]
    r = np.sqrt((y - (h - 1) / 2) ** 2 + (x - (w - 1) / 2) ** 2).ravel()
    a, b = A.ravel().astype(float), B.ravel().astype(float)
    outer = r.max()
    good = (a > 4) & (a < 250) & (b > 4) & (b < 250)
    r, a, b = r[good], a[good], b[good]
    near = r < outer / 4
    values = np.unique(a[near])
    T = np.array([np.median(b[near & (a == v)]) for v in values])
    inside = (a >= values[0]) & (a <= values[-1])
    r, off = r[inside], (b - np.interp(a, values, T))[inside]
    width = 0.75 * outer / rings
    bad = []
    for i in range(rings):
        start = outer / 4 + i * width
        ring = off[(r >= start) & (r < start + width)]
        bad.append(len(ring) > 0 and not -tolerance <= np.median(ring) <= tolerance)
    bad.append(bad[-1])
    pairs = [i for i in range(rings) if bad[i] and bad[i + 1]]
    return outer / 4 + pairs[0] * width if pairs else outer
