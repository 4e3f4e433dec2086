"""Pixel by pixel, N and R spread to the shape of X."""

import numpy as np


def variance(X, D, N, R):
    X = np.asarray(X, float)
    D, N, R = (np.broadcast_to(np.asarray(a, float), X.shape) for a in (D, N, R))
    V = np.empty(X.shape)
    for k in np.ndindex(X.shape):
        V[k] = X[k] / N[k] + R[k] ** 2 / N[k] ** 2 + D[k] ** 2 / 12
    return V
