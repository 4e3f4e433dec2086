"""Two matrices of Gaussian weights, one for the rows and one for the columns, each row summing to 1."""

import numpy as np


def weights(n, sigma):
    return [[np.exp(-((i - j) ** 2) / (2.0 * sigma * sigma)) for j in range(n)] for i in range(n)]


def normalised(matrix):
    matrix = np.array(matrix)
    return matrix / matrix.sum(axis=1, keepdims=True)


def scale(L, *, headroom=8.0, sigma=None):
    L = np.array(L, dtype=float)
    sigma = sigma or 0.1 * max(L.shape)
    blurred = normalised(weights(L.shape[0], sigma)) @ L @ normalised(weights(L.shape[1], sigma)).T
    blurred[blurred == 0] = np.inf
    return 1 / headroom / blurred
