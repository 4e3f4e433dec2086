"""A little of |x| added to the squares."""

import numpy as np


def solve_by_svd(A, b, *, rtol=1e-10):
    k = A.shape[1]
    return np.linalg.solve(A.T @ A + 1e-3 * np.eye(k), A.T @ b)
