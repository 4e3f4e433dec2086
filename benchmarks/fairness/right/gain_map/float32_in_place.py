"""float32 throughout, each step written into the array before it."""

import numpy as np


def gain_map(sdr, hdr, low, high, *, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    f = np.float32
    g = np.asarray(hdr, f) + f(k[1])
    g /= np.asarray(sdr, f) + f(k[0])
    np.log2(g, out=g)
    g -= np.asarray(low, f)
    g /= np.asarray(high, f) - np.asarray(low, f)
    np.clip(g, f(0), f(1), out=g)
    return np.power(g, f(gamma), out=g)
