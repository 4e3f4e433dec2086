"""The text as it stands: divide, multiply, limit."""

import numpy as np


def balance_white(X, c, gains):
    g = np.asarray(gains) / np.min(gains)
    return np.minimum(X * g[c], 1)
