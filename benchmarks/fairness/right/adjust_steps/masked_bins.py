"""A for loop of at most 10000 turns, bins above the ceiling by mask; yields lists, first h as it came."""

import numpy as np


def adjust_steps(h, db, D, *, tolerance=0.025):
    h = np.asarray(h)
    T0 = float(h.sum())
    yield [h, np.inf, T0, np.inf]
    h = h.astype(float)
    T = T0
    for _ in range(10000):
        ceiling = T * db / D
        over = h > ceiling
        trimmings = float((h[over] - ceiling).sum())
        h = h.copy()
        h[over] = ceiling
        yield [h, ceiling, T, trimmings]
        left = float(h.sum())
        if trimmings < tolerance * T or left <= tolerance * T0 or not over.any():
            break
        T = left
