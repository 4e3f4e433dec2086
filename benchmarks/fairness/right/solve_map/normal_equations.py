"""(A^T A + diag(1 / sd^2)) c = A^T b."""

import numpy as np


def solve_map(A, b, sd):
    return np.linalg.solve(A.T @ A + np.diag(sd**-2.0), A.T @ b)
