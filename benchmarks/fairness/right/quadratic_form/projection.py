"""The projection 1 - A (A^T A)^-1 A^T."""

import numpy as np


def quadratic_form(blends, degree):
    parts = []
    for I, M in blends:
        A = np.stack([I, 0 * I + 1], axis=1)
        P = np.eye(len(I)) - A @ np.linalg.inv(A.T @ A) @ A.T
        V = M.reshape(-1, 1) ** np.arange(degree + 1.0)
        parts.append(V.T @ P @ V)
    return np.sum(parts, axis=0)
