"""f / f' is 1 / g', since f' = f g'."""

import numpy as np


def snr(g, *, least=0.01, span=4):
    g = np.asarray(g, float)
    n, f = len(g), np.exp(g - g[-1])
    z = np.arange(n)
    low, high = np.maximum(z - span, 0), np.minimum(z + span, n - 1)
    mean = (f[-1] - f[0]) / (n - 1)
    w = 1 / np.maximum((g[high] - g[low]) / (high - low), least * mean / f)
    w[[0, -1]] = 0
    return w
