"""By what is left after the trim."""

import numpy as np


def adjust_steps(h, db, D, *, tolerance=0.025):
    h = np.array(h, float)
    first = h.sum()
    yield h, np.inf, first, np.inf
    while True:
        T = h.sum()
        ceiling = T * db / D
        trimmings = np.maximum(h - ceiling, 0).sum()
        h = np.minimum(h, ceiling)
        yield h, ceiling, T, trimmings
        if trimmings < tolerance * h.sum() or h.sum() <= tolerance * first:
            return
