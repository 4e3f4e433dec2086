"""numpy's digitize, and ndimage's medians of labels."""

import numpy as np
from scipy import ndimage


def circle(A, B, tolerance=1.0, rings=40):
    h, w = A.shape
    r = np.hypot((np.arange(h) - (h - 1) / 2)[:, None], np.arange(w) - (w - 1) / 2)
    outer = r[0, 0]
    A, B = A.astype(np.int64), B.astype(np.int64)
    usable = (A > 4) & (A < 250) & (B > 4) & (B < 250)
    middle = usable & (r < outer / 4)
    sums = np.bincount(A[middle], weights=B[middle], minlength=256)
    counts = np.bincount(A[middle], minlength=256)
    z = counts.nonzero()[0]
    usable &= (A >= z[0]) & (A <= z[-1])
    off = B - np.interp(A, z, sums[z] / counts[z])
    edges = np.linspace(outer / 4, outer, rings + 1)
    label = np.where(usable, np.digitize(r, edges), 0)
    medians = ndimage.median(off, label, np.arange(1, rings + 1))
    bad = np.abs(np.nan_to_num(np.atleast_1d(medians))) > tolerance
    both = bad & np.append(bad[1:], bad[-1])
    return edges[np.argmax(both)] if both.any() else outer
