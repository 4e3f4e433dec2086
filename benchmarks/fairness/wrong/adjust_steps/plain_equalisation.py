"""Wrong: plain histogram equalisation: nothing is ever trimmed, the ceiling is only reported."""

import numpy as np


def adjust_steps(h, db, D, *, tolerance=0.025):
    h = np.asarray(h, dtype=float)
    T = h.sum()
    yield h, np.inf, T, np.inf
    yield h, T * db / D, T, 0.0
