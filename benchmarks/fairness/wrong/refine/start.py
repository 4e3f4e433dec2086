"""The start, without a search."""

import numpy as np


def refine(X, start, *, reach=1.0):
    return np.round(start)
