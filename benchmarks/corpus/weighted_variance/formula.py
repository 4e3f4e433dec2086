import numpy as np


def weighted_variance(x, w):
    total = w.sum(axis=0)
    safe = np.where(total > 0, total, 1)
    mean = (w * x).sum(axis=0) / safe
    return (w * (x - mean) ** 2).sum(axis=0) / safe
