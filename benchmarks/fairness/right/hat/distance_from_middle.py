"""1 minus the distance from the middle, in units of (n - 1) / 2: a triangle, not renormalised."""

import numpy as np


def hat(n=256):
    if n == 1:
        return np.array([1.0])
    return 1.0 - np.abs(np.linspace(-1.0, 1.0, n))
