"""numpy's least squares of the whole matrix."""

import numpy as np


def sharpen(y, h):
    m = len(h)
    n = len(y) - m + 1
    A = np.zeros((len(y), n))
    for j in range(n):
        A[j : j + m, j] = h / m
    return np.linalg.lstsq(A, y, rcond=None)[0]
