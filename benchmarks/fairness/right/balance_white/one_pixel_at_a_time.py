"""Loops over rows and columns."""

import numpy as np


def balance_white(X, c, gains):
    low = min(gains)
    out = np.empty(X.shape)
    for y in range(X.shape[0]):
        for x in range(X.shape[1]):
            out[y, x] = min(X[y, x] * gains[c[y, x]] / low, 1)
    return out
