"""Level by level, in plain numbers."""

import math


def snr(g, *, least=0.01, span=4):
    n = len(g)
    f = [math.exp(float(one)) for one in g]
    mean = (f[-1] - f[0]) / (n - 1)
    w = []
    for z in range(n):
        a, b = max(0, z - span), min(n - 1, z + span)
        slope = (f[b] - f[a]) / (b - a)
        w.append(f[z] / max(slope, least * mean))
    w[0] = w[-1] = 0.0
    return w
