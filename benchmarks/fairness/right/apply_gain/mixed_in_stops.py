"""Both ends of the range weighted by the share, and exp2."""

import numpy as np


def apply_gain(sdr, g, low, high, *, W=1.0, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    share = np.power(g, np.divide(1.0, gamma))
    G = np.multiply(low, 1 - share) + np.multiply(high, share)
    return np.exp2(W * G) * (np.asarray(sdr) + k[0]) - k[1]
