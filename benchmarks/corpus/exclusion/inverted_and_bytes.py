import numpy as np


def exclusion(Y, t):
    med = np.uint8(t)
    eb = np.ones_like(Y)
    eb[np.abs(Y - med) > 4] = 0  # remove the noisy ones
    return eb.astype(bool)
