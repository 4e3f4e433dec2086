"""Divides by 2 span also at the ends."""

import numpy as np


def snr(g, *, least=0.01, span=4):
    f = np.exp(g)
    n = len(f)
    z = np.arange(n)
    slope = (f[np.minimum(z + span, n - 1)] - f[np.maximum(z - span, 0)]) / (2 * span)
    w = f / np.maximum(slope, least * (f[-1] - f[0]) / (n - 1))
    w[[0, -1]] = 0
    return w
