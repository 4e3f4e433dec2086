"""l (cov(V, V) - cov(V, I) cov(I, V) / var(I)), with centered values."""

import numpy as np


def quadratic_form(blends, degree):
    total = np.zeros((degree + 1, degree + 1))
    for blend in blends:
        I = blend[0] - blend[0].mean()
        V = np.array([blend[1] ** k for k in range(degree + 1)])
        V = V - V.mean(axis=1, keepdims=True)
        c = V @ I
        total += V @ V.T - np.outer(c, c) / (I @ I)
    return total
