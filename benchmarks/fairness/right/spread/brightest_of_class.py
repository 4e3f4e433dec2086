"""hsplit, and the brightest luminance of each class."""

import numpy as np


def spread(L, Ld, *, bins=64):
    both = np.vstack([L.reshape(1, -1), Ld.reshape(1, -1)])
    both = both[:, both[0].argsort(kind="mergesort")]
    parts = np.hsplit(both, bins)
    return np.array([[p[0].max(), p[1].min(), p[1].max()] for p in parts]).T
