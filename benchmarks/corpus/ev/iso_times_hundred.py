import numpy as np


def ev(F, T, *, S=100.0):
    # same as the exposure calculator: N^2/t, then ISO correction
    F, T, S = np.asarray(F, float), np.asarray(T, float), np.asarray(S, float)
    value = np.log2(F**2 / T)
    correction = np.log2(S / 100.0)
    return value + correction
