"""math.log2 of one number at a time, in a flat loop; ranges are broadcast first."""

import math

import numpy as np


def gain_map(sdr, hdr, low, high, *, gamma=1.0, k=(1 / 1024, 1 / 1024)):
    shape = np.shape(sdr)
    lows, highs = np.broadcast_to(low, shape).ravel(), np.broadcast_to(high, shape).ravel()
    found = []
    for s, h, a, b in zip(np.ravel(sdr), np.ravel(hdr), lows, highs, strict=True):
        share = (math.log2((h + k[1]) / (s + k[0])) - a) / (b - a)
        found.append(0.0 if share <= 0 else 1.0 if share >= 1 else share**gamma)
    return np.reshape(found, shape)
