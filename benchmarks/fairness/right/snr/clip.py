"""Ends by clip, slope over the levels that are really between, largest of it and the bound."""

import numpy as np


def snr(g, *, least=0.01, span=4):
    f = np.exp(g)
    n = len(f)
    z = np.arange(n)
    lo, hi = np.clip(z - span, 0, n - 1), np.clip(z + span, 0, n - 1)
    slope = np.maximum((f[hi] - f[lo]) / (hi - lo), least * (f[-1] - f[0]) / (n - 1))
    w = f / slope
    w[[0, -1]] = 0
    return w
