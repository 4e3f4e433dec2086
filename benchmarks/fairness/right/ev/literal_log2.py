"""Translates the formula term by term; a NaN setting counts as not positive."""

import numpy as np


def ev(F, T, *, S=100.0):
    F, T, S = (np.asarray(x, dtype=np.float64) for x in (F, T, S))
    for name, value in (("F", F), ("T", T), ("S", S)):
        if not np.all(value > 0):
            raise ValueError(f"{name} must be positive")
    return 2 * np.log2(F) - np.log2(T) - np.log2(S / 100)
