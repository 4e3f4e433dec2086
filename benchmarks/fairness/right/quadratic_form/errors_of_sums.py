"""From E of single powers and of sums of two: Q_kl = (E(k + l) - E(k) - E(l)) / 2."""

import numpy as np


def left(I, y):
    A = np.column_stack([np.ones(len(I)), I])
    return float(np.sum((y - A @ np.linalg.lstsq(A, y, rcond=None)[0]) ** 2))


def quadratic_form(blends, degree):
    n = degree + 1
    Q = [[0.0] * n for _ in range(n)]
    for I, M in blends:
        single = [left(I, M**k) for k in range(n)]
        for k in range(n):
            for j in range(n):
                Q[k][j] += (left(I, M**k + M**j) - single[k] - single[j]) / 2
    return Q
