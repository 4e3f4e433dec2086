"""The range of the frames that have a weight."""

import numpy as np


def weighted_variance(x, w):
    high = np.where(w > 0, x, -np.inf).max(axis=0)
    low = np.where(w > 0, x, np.inf).min(axis=0)
    return np.where(high >= low, high - low, 0)
