"""Standard deviations, put together at right angles, and squared."""

import numpy as np


def variance(X, D, N, R):
    shot = np.sqrt(np.maximum(X, 0) / N)
    rest = np.hypot(np.asarray(R) / N, np.asarray(D) / np.sqrt(12))
    return np.hypot(shot, rest) ** 2
