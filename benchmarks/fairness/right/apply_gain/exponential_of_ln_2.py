"""The power of 2 as exp of ln 2 times the stops."""

import numpy as np


def apply_gain(sdr, g, low, high, *, W=1.0, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    G = np.add(low, np.subtract(high, low) * np.exp(np.log(np.maximum(g, 1e-300)) / gamma))
    return (np.asarray(sdr, float) + k[0]) * np.exp(np.log(2.0) * W * G) - k[1]
