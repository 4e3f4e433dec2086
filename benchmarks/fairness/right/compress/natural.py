"""By natural logarithms over ln 10; float64."""

import numpy as np


def compress(base, low, high, *, contrast=50.0):
    span = max(high - low, 1e-9)
    m = np.log(contrast) / np.log(10) / span
    return np.asarray(base, float) * (m if m < 1 else 1) - high * (m if m < 1 else 1)
