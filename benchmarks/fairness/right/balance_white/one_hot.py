"""A matrix product with the one-hot filters."""

import numpy as np


def balance_white(X, c, gains):
    one_hot = np.eye(3)[np.asarray(c)]
    g = one_hot @ np.asarray(gains) / np.amin(gains)
    return np.clip(X * g, None, 1.0)
