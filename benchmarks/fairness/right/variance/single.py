"""In float32 throughout."""

import numpy as np


def variance(X, D, N, R):
    X, D, N, R = (np.asarray(a, np.float32) for a in (X, D, N, R))
    return X / N + np.square(R / N) + np.square(D) / np.float32(12)
