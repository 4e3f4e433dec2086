"""Both powers as exponentials of logarithms, with the logarithm of zero as minus infinity."""

import numpy as np


def pq(FD):
    m1, m2 = 2610 / 16384, 128 * (2523 / 4096)
    c1, c2, c3 = 3424 / 4096, 32 * (2413 / 4096), 32 * (2392 / 4096)
    FD = np.asarray(FD, dtype=float)
    with np.errstate(divide="ignore"):
        log_Y = np.log(FD) - np.log(10_000.0)
    Ym = np.exp(m1 * log_Y)
    return np.exp(m2 * (np.log(c1 + c2 * Ym) - np.log(1 + c3 * Ym)))
