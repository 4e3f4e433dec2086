"""Plain Python numbers, pixel by pixel, written into a mask that is True at first."""

import numpy as np


def exclusion(Y, t):
    Y = np.asarray(Y)
    votes = np.ones(Y.shape, dtype=bool)
    flat = votes.reshape(-1)
    for i, y in enumerate(Y.ravel().tolist()):
        if -4 <= y - int(t) <= 4:
            flat[i] = False
    return votes
