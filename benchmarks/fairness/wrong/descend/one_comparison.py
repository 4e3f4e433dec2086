"""The photos are compared once."""

import numpy as np


def descend(T, start, *, low=12.0):
    return np.array([start, np.interp(start, np.arange(len(T)), T)])
