"""Two comparisons; 0 and 1."""

import numpy as np


def exclusion(Y, t):
    Y = Y.astype(np.int16)
    return ((Y < t - 4) | (Y > t + 4)).astype(np.uint8)
