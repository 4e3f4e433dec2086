"""The formulas as they stand, one after the other."""

import numpy as np


def gain_map(sdr, hdr, low, high, *, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    k_sdr, k_hdr = k
    G = np.log2((hdr + k_hdr) / (sdr + k_sdr))
    share = (G - low) / (np.asarray(high) - np.asarray(low))
    return np.clip(share, 0, 1) ** gamma
