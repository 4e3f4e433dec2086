"""The codes t - 4 and t + 4 are within the noise too: compare with > 4, not >= 4."""

import numpy as np


def exclusion(Y, t):
    return np.abs(Y.astype(int) - t) >= 4
