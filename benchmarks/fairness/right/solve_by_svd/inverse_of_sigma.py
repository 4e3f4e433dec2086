"""1 / sigma, and 0 where sigma is as good as 0."""

import numpy as np
from scipy import linalg


def solve_by_svd(A, b, rtol=1e-10):
    U, s, Vh = linalg.svd(A, full_matrices=False)
    large = s > rtol * s.max()
    inverse = np.where(large, 1 / np.where(large, s, 1), 0)
    return Vh.T @ np.diag(inverse) @ U.T @ b[:, None]
