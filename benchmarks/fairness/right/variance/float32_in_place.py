"""Single precision, each term added to what is there."""

import numpy as np


def variance(X, D, N, R):
    V = np.array(D, dtype=np.float32)
    V *= V
    V /= np.float32(12)
    V += np.asarray(X, np.float32) / np.float32(N)
    V += np.float32(R / N) ** 2
    return V
