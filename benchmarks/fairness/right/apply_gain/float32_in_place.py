"""float32 throughout, each step written into the array before it."""

import numpy as np


def apply_gain(sdr, g, low, high, *, W=1.0, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    f = np.float32
    light = np.asarray(g, f) ** (f(1) / np.asarray(gamma, f))
    light *= np.asarray(high, f) - np.asarray(low, f)
    light += np.asarray(low, f)
    light *= f(W)
    np.exp2(light, out=light)
    light *= np.asarray(sdr, f) + f(k[0])
    light -= f(k[1])
    return light
