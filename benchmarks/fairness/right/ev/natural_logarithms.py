"""Natural logarithms divided by ln 2, and min() for the check, so arrays without entries pass."""

import numpy as np

LN2 = np.log(2.0)


def _positive(value):
    value = np.asarray(value) * 1.0
    if value.size and not value.min() > 0:
        raise ValueError("a setting is not positive")
    return value


def ev(F, T, *, S=100.0):
    F = _positive(F)
    T = _positive(T)
    S = _positive(S)
    return (2 * np.log(F) - np.log(T) - np.log(S) + np.log(100.0)) / LN2
