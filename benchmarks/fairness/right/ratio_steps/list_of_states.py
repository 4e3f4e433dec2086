"""A list, and sums with a mask of 0 and 1."""

import numpy as np


def solve(x, y, v, m):
    k = (m * v * v * x * y).sum() / (m * v * v * x * x).sum()
    return k, (m * (v * (y - k * x)) ** 2).sum() / m.sum()


def ratio_steps(found, *, limit=9.0, tolerance=1e-6, rounds=100):
    x, y, v = (np.asarray(one, float) for one in found)
    m = np.ones_like(x)
    k, V = solve(x, y, v, m)
    states = [(k, m, V)]
    while len(states) <= rounds:
        m = ((v * (y - k * x)) ** 2 <= limit * V).astype(float)
        last, (k, V) = k, solve(x, y, v, m)
        states.append((k, m, V))
        if abs(k - last) < tolerance:
            break
    return states
