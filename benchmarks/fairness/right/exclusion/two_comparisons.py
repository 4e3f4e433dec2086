"""No difference at all: above t + 4 or below t - 4, with t a Python int."""

import numpy as np


def exclusion(Y, t):
    Y = np.asarray(Y)
    t = int(t)
    return (Y > t + 4) | (Y < t - 4)
