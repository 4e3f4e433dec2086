"""The fraction rewritten as 1 minus what is missing to white (since c1 = c3 - c2 + 1), its power by log1p
and exp."""

import numpy as np


def pq(FD):
    m1 = 2610 / 16384
    m2 = 128 * 2523 / 4096
    c1 = 3424 / 4096
    c3 = 32 * 2392 / 4096
    # c1 + c2 y = 1 + c3 y - (1 - c1) (1 - y), as c2 - c3 = 1 - c1
    y = np.power(np.divide(FD, 10_000.0), m1)
    missing = (1 - c1) * (1 - y) / (1 + c3 * y)
    return np.exp(m2 * np.log1p(-missing))
