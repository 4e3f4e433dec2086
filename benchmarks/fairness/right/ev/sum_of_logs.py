"""Term by term."""

import numpy as np


def ev(F, T, *, S=100.0):
    F, T, S = (np.asarray(x, float) for x in (F, T, S))
    if (F <= 0).any() or (T <= 0).any() or (S <= 0).any():
        raise ValueError("settings must be positive")
    return 2 * np.log2(F) - np.log2(T) - np.log2(S / 100)
