"""A generator with `while True` and two conditions to leave it; plain tuples."""

import numpy as np


def adjust_steps(h, db, D, *, tolerance=0.025):
    h = np.array(h, dtype=float)
    first = h.sum()
    yield h, np.inf, first, np.inf
    while True:
        T = h.sum()
        ceiling = T * db / D
        trimmings = np.maximum(h - ceiling, 0).sum()
        h = np.minimum(h, ceiling)
        yield h, ceiling, T, trimmings
        if trimmings < tolerance * T or trimmings == 0:
            return
        if h.sum() <= tolerance * first:
            return
