"""Natural logarithms over ln 2."""

import numpy as np


def ev(F, T, *, S=100.0):
    if np.any(np.array(F) <= 0) or np.any(np.array(T) <= 0) or np.any(np.array(S) <= 0):
        raise ValueError("not positive")
    return (2 * np.log(F) - np.log(T) - np.log(S / 100)) / np.log(2)
