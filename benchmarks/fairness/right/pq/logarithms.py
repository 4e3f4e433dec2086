"""Powers as exponentials of logarithms; black apart."""

import numpy as np


def pq(FD):
    FD = np.asarray(FD, float)
    x = np.zeros(FD.shape)
    lit = FD > 0
    x[lit] = np.exp(2610 / 16384 * np.log(FD[lit] / 1e4))
    top = 3424 / 4096 + 32 * 2413 / 4096 * x
    bottom = 1 + 32 * 2392 / 4096 * x
    return np.exp(128 * 2523 / 4096 * (np.log(top) - np.log(bottom)))
