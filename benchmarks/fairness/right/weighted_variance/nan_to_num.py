"""Divides, and puts 0 where that was 0 / 0."""

import numpy as np


def weighted_variance(x, w):
    with np.errstate(invalid="ignore"):
        m = np.sum(w * x, axis=0) / np.sum(w, axis=0)
        v = np.sum(w * (x - m) ** 2, axis=0) / np.sum(w, axis=0)
    return np.nan_to_num(v)
