"""Frame by frame, as the mean and the sum of squares are brought up to date (West, 1979)."""

import numpy as np


def weighted_variance(x, w):
    total = np.zeros(x.shape[1:])
    mean = np.zeros(x.shape[1:])
    squares = np.zeros(x.shape[1:])
    for xj, wj in zip(x, w, strict=True):
        total = total + wj
        step = xj - mean
        part = np.where(total > 0, wj / np.where(total > 0, total, 1), 0)
        mean = mean + part * step
        squares = squares + wj * step * (xj - mean)
    return np.where(total > 0, squares / np.where(total > 0, total, 1), 0)
