"""The formula as it stands, with NumPy's powers in double precision."""

import numpy as np


def pq(FD):
    m1 = 2610 / 16384
    m2 = 128 * 2523 / 4096
    c1 = 3424 / 4096
    c2 = 32 * 2413 / 4096
    c3 = 32 * 2392 / 4096
    y = (np.asarray(FD, dtype=float) / 10_000) ** m1
    return ((c1 + c2 * y) / (1 + c3 * y)) ** m2
