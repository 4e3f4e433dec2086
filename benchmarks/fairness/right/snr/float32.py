"""In float32, the middle level at 1, as the exposure of the middle level is."""

import numpy as np


def snr(g, *, least=0.01, span=4):
    g = np.asarray(g, np.float32)
    f = np.exp(g - g[len(g) // 2])
    n = len(f)
    index = np.arange(n)
    a, b = np.maximum(index - span, 0), np.minimum(index + span, n - 1)
    d = (f[b] - f[a]) / (b - a).astype(np.float32) * np.float32(n - 1) / (f[-1] - f[0])
    d[d < least] = least
    w = f / d
    w[[0, n - 1]] = 0
    return w
