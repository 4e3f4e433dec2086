import numpy as np


def ev(F, T, *, S=100.0):
    F = np.asarray(F, dtype=np.float64)
    T = np.asarray(T, dtype=np.float64)
    S = np.asarray(S, dtype=np.float64)
    result = np.log(F * F) - np.log(T) - np.log(S / 100)
    return result
