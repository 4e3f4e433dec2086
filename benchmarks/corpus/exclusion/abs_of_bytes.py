import numpy as np


def exclusion(Y, t):
    diff = np.abs(Y - np.uint8(t))
    mask = diff > 4
    return mask
