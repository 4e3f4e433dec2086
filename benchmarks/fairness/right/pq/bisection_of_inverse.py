"""The formula solved for Y, and v found for each luminance by bisection between 0 and 1."""

import numpy as np


def pq(FD):
    m1, m2 = 2610 / 16384, 128 * 2523 / 4096
    c1, c2, c3 = 3424 / 4096, 32 * 2413 / 4096, 32 * 2392 / 4096
    FD = np.asarray(FD, dtype=float)

    def luminance(v):
        e = v ** (1 / m2)
        return 10_000 * (np.maximum(e - c1, 0) / (c2 - c3 * e)) ** (1 / m1)

    low, high = np.zeros(FD.shape), np.ones(FD.shape)
    for _ in range(40):
        v = (low + high) / 2
        dark = luminance(v) < FD
        low = np.where(dark, v, low)
        high = np.where(dark, high, v)
    return (low + high) / 2
