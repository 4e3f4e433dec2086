import numpy as np


def solve_by_svd(A, b, *, rtol=1e-10):
    A = np.asarray(A, float)
    N = A.T @ A
    return np.linalg.solve(N + rtol * np.trace(N) * np.eye(A.shape[1]), A.T @ np.asarray(b, float))
