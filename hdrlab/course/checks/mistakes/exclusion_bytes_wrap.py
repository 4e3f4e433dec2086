"""Y is of one byte: where Y is less than t, Y - t wraps around to a large number. Turn Y into int first."""

import numpy as np


def exclusion(Y, t):
    return np.abs(Y - np.uint8(t)) > 4
