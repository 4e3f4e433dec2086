import numpy as np


def weighted_variance(x, w):
    s = np.sum(w, axis=0) + 1e-12
    mu = np.sum(w * x, axis=0) / s
    return np.sqrt(np.sum(w * (x - mu) ** 2, axis=0) / s)
