"""As int, the absolute difference."""

import numpy as np


def exclusion(Y, t):
    return np.abs(Y.astype(int) - int(t)) > 4
