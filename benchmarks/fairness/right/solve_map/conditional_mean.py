"""The mean of a Gaussian, given b: S A^T (A S A^T + 1)^-1 b."""

import numpy as np


def solve_map(A, b, sd):
    S = np.diag(sd**2)
    return S @ A.T @ np.linalg.solve(A @ S @ A.T + np.eye(len(b)), b)
