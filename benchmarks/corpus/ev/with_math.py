import numpy as np


def ev(F, T, *, S=100.0):
    F = np.array(F, dtype=float)
    T = np.array(T, dtype=float)
    S = np.array(S, dtype=float)
    ev100 = np.log2(F**2 / T)
    return ev100 - np.log2(S / 100)
