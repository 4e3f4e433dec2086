"""Width by width."""

import numpy as np


def scale_steps(blurred, *, key=0.18, phi=8.0, threshold=0.05):
    V1 = list(blurred)
    even, adaptation = np.ones(V1[0].shape, bool), V1[0]
    for k in range(8):
        s = 1.6**k
        V = (V1[k] - V1[k + 1]) / (2**phi * key / s**2 + V1[k])
        even = even & (np.abs(V) < threshold)
        adaptation = np.where(even, V1[k], adaptation)
        yield s, V1[k], V, even, adaptation
