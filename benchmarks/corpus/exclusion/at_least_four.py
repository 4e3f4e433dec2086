import numpy as np


def exclusion(Y, t):
    Y = np.array(Y, dtype=float)
    res = np.ones(Y.shape)
    res[(Y < t + 4) & (Y > t - 4)] = 0
    return res == 1
