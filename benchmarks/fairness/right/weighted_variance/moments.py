"""The mean of squares less the square of the mean, about the mean of all x."""

import numpy as np


def weighted_variance(x, w):
    x = x - x.mean(axis=0)
    s = np.maximum(w.sum(axis=0), 1e-12)
    first, second = (w * x).sum(axis=0) / s, (w * x * x).sum(axis=0) / s
    return np.maximum(second - first**2, 0)
