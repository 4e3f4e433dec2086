import numpy as np


def exclusion(Y, t):
    noise = 4
    upper = np.where(Y.astype(np.int32) > t + noise, 1, 0)
    lower = np.where(Y.astype(np.int32) < t - noise, 1, 0)
    return (upper + lower).astype(bool)
