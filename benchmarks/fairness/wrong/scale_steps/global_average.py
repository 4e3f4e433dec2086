"""Wrong: every pixel adapts to one global average, no pixel's own neighbourhood is searched."""

import numpy as np


def scale_steps(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    blurred = [np.asarray(b, dtype=float) for b in blurred]
    average = np.full(blurred[0].shape, blurred[0].mean())
    for i, (V1, V2) in enumerate(zip(blurred, blurred[1:])):
        s = 1.6**i
        V = (V1 - V2) / (2**phi * key / s**2 + V1)
        yield s, V1, V, np.abs(V) < threshold, average
