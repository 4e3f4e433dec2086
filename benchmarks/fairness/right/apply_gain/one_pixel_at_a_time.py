"""A loop over all numbers of the picture; ranges and gamma are broadcast first."""

import numpy as np


def apply_gain(sdr, g, low, high, *, W=1.0, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    shape = np.shape(sdr)
    each = [np.broadcast_to(one, shape).ravel() for one in (sdr, g, low, high, gamma)]
    light = []
    for s, m, a, b, power in zip(*each, strict=True):
        G = a + (b - a) * float(m) ** (1.0 / power)
        light.append((s + k[0]) * 2.0 ** (W * G) - k[1])
    return np.array(light).reshape(shape)
