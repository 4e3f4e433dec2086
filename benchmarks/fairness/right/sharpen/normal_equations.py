"""A^T A x = A^T y, with A from toeplitz."""

import numpy as np
from scipy.linalg import toeplitz


def sharpen(y, h):
    n = len(y) - len(h) + 1
    A = toeplitz(np.concatenate([h, np.zeros(n - 1)]) / len(h), [h[0] / len(h)] + [0] * (n - 1))
    return np.linalg.solve(A.T @ A, A.T @ y)
