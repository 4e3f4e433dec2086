"""The mean slope made 1 first, so the bound is least itself; inner levels only are computed."""

import numpy as np


def snr(g, *, least=0.01, span=4):
    f = np.exp(np.asarray(g, float) - np.median(g))
    n = len(f)
    f = f * (n - 1) / (f[-1] - f[0])
    z = np.arange(1, n - 1)
    a, b = np.maximum(z - span, 0), np.minimum(z + span, n - 1)
    slope = (np.take(f, b) - np.take(f, a)) / (b - a)
    return np.concatenate(([0.0], f[1:-1] / np.where(slope < least, least, slope), [0.0]))
