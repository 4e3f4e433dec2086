import numpy as np


def _blur(a, sigma=2.0):
    r = int(np.ceil(3 * sigma))
    t = np.arange(-r, r + 1)
    g = np.exp(-(t**2) / (2 * sigma**2))
    g /= g.sum()
    for axis in (0, 1):
        pad = [(0, 0), (0, 0)]
        pad[axis] = (r, r)
        p = np.pad(a, pad, mode="edge")
        n = a.shape[axis]
        out = np.zeros(a.shape)
        for i, gi in enumerate(g):
            out += gi * np.take(p, range(i, i + n), axis=axis)
        a = out
    return a


def fix_uncertain(mean, k, *, sigma_s):
    mean = np.asarray(mean, dtype=np.float64)
    u = np.log(np.asarray(k, dtype=np.float64)) / np.log(np.sqrt(2 * np.pi) * sigma_s)
    u[u < 0] = 0
    u[u > 1] = 1
    return u * mean + (1 - u) * _blur(mean)
