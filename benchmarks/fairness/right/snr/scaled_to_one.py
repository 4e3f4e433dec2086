"""Arrays; the largest weight is 1."""

import numpy as np


def snr(g, *, least=0.01, span=4):
    f = np.exp(np.asarray(g, float))
    z = np.arange(f.size)
    low, high = (z - span).clip(0), (z + span).clip(max=f.size - 1)
    slope = (f[high] - f[low]) / (high - low)
    w = f / np.maximum(slope, least * (f[-1] - f[0]) / (f.size - 1))
    w[0] = w[-1] = 0
    return w / w.max()
