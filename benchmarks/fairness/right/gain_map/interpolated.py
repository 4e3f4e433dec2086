"""np.interp of the gain between low and high, which holds the ends beyond them."""

import numpy as np


def gain_map(sdr, hdr, low, high, *, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    G = np.log2((np.asarray(hdr) + k[1]) / (np.asarray(sdr) + k[0]))
    span = np.asarray(high, float) - low
    return np.interp((G - low) / span, [0.0, 1.0], [0.0, 1.0]) ** gamma
