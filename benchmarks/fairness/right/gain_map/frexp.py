"""The logarithm by frexp: a whole exponent, and log1p of what is left of the mantissa."""

import numpy as np


def gain_map(sdr, hdr, low, high, *, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    mantissa, exponent = np.frexp((np.asarray(hdr, float) + k[1]) / (np.asarray(sdr, float) + k[0]))
    G = exponent + np.log1p(mantissa - 1) / np.log(2)
    return np.clip((G - low) / (np.asarray(high) - low), 0, 1) ** gamma
