"""The formulas as they stand."""

import numpy as np


def apply_gain(sdr, g, low, high, *, W=1.0, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    k_sdr, k_hdr = k
    G = low + (np.asarray(high) - low) * np.asarray(g) ** (1 / np.asarray(gamma))
    return (sdr + k_sdr) * 2 ** (W * G) - k_hdr
