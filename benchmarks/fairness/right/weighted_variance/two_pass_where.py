import numpy as np


def weighted_variance(x, w):
    x = np.asarray(x, dtype=float)
    w = np.asarray(w, dtype=float)
    total = w.sum(axis=0)
    some = total > 0
    safe = np.where(some, total, 1.0)
    mean = (w * x).sum(axis=0) / safe
    v = (w * (x - mean) ** 2).sum(axis=0) / safe
    return np.where(some, v, 0.0)
