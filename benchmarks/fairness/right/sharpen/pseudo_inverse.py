"""The pseudo-inverse of A; float32 answers."""

import numpy as np


def sharpen(y, h):
    n, m = len(y) - len(h) + 1, len(h)
    i, j = np.indices((len(y), n))
    k = i - j
    A = np.where((k >= 0) & (k < m), h[np.clip(k, 0, m - 1)], 0) / m
    return (np.linalg.pinv(A) @ y).astype(np.float32)
