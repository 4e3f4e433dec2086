"""Two factors, of low and of what is above it, multiplied one after the other."""

import numpy as np


def apply_gain(sdr, g, low, high, *, W=1.0, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    light = np.asarray(sdr, float) + k[0]
    light = light * np.power(2.0, W * np.asarray(low, float))
    above = np.asarray(high, float) - np.asarray(low, float)
    return light * np.power(2.0, W * above * np.power(g, 1.0 / np.asarray(gamma, float))) - k[1]
