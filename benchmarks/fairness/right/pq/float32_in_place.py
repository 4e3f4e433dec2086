"""float32 throughout, over the ravelled array and in place with ufuncs and their out argument."""

import numpy as np


def pq(FD):
    f = np.float32
    FD = np.asarray(FD)
    y = FD.astype(f).ravel()
    np.divide(y, f(10_000), out=y)
    np.power(y, f(2610 / 16384), out=y)
    under = np.multiply(y, f(32 * 2392 / 4096))
    np.add(under, f(1), out=under)
    np.multiply(y, f(32 * 2413 / 4096), out=y)
    np.add(y, f(3424 / 4096), out=y)
    np.divide(y, under, out=y)
    np.power(y, f(128 * 2523 / 4096), out=y)
    return y.reshape(FD.shape)
