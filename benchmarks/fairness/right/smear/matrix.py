"""A matrix with the code down each column."""

import numpy as np
from scipy.linalg import toeplitz


def smear(x, h):
    n = len(x)
    A = toeplitz(np.r_[h, np.zeros(n - 1)], np.r_[h[0], np.zeros(n - 1)])
    return (A / len(h)) @ x
