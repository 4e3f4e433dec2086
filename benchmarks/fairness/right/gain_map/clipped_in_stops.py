"""The gain is clipped to low ... high before its share is taken; logarithms apart."""

import numpy as np


def gain_map(sdr, hdr, low, high, *, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    G = np.log2(np.add(hdr, k[1])) - np.log2(np.add(sdr, k[0]))
    inside = np.minimum(np.maximum(G, low), high)
    return np.power((inside - low) / np.subtract(high, low), gamma)
