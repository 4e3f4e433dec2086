"""Level by level, scaled so that the largest weight is 1."""

import math

import numpy as np


def snr(g, *, least=0.01, span=4):
    n = len(g)
    top = max(float(x) for x in g)
    f = [math.exp(float(x) - top) for x in g]
    bound = least * (f[n - 1] - f[0]) / (n - 1)
    w = np.zeros(n)
    for z in range(1, n - 1):
        a, b = max(z - span, 0), min(z + span, n - 1)
        w[z] = f[z] / max((f[b] - f[a]) / (b - a), bound)
    return w / w.max()
