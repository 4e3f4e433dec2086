"""A generator that translates the formulas one by one, in float64, and yields plain tuples."""

import numpy as np


def scale_steps(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    blurred = [np.asarray(b, dtype=float) for b in blurred]
    even = np.ones(blurred[0].shape, dtype=bool)
    adaptation = blurred[0].copy()
    for i in range(len(blurred) - 1):
        s = 1.6**i
        V1, V2 = blurred[i], blurred[i + 1]
        V = (V1 - V2) / (2**phi * key / s**2 + V1)
        even = even & (np.abs(V) < threshold)
        adaptation = np.where(even, V1, adaptation)
        yield s, V1, V, even, adaptation
