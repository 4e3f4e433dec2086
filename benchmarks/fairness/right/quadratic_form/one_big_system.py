"""All blends in one system with two columns each; what is left of the powers."""

import numpy as np


def quadratic_form(blends, degree):
    sizes = [len(I) for I, _ in blends]
    A = np.zeros((sum(sizes), 2 * len(blends)))
    V = np.zeros((sum(sizes), degree + 1))
    start = 0
    for j, (I, M) in enumerate(blends):
        rows = slice(start, start + len(I))
        A[rows, 2 * j], A[rows, 2 * j + 1] = I, 1
        V[rows] = M[:, None] ** np.arange(degree + 1)
        start += len(I)
    R = V - A @ (np.linalg.pinv(A) @ V)
    return R.T @ R
