import numpy as np


def weighted_variance(x, w):
    mu = np.mean(x, axis=0)
    s = np.sum(w, axis=0)
    s[s == 0] = 1
    return np.sqrt(np.sum(w * (x - mu) ** 2, axis=0) / s)
