"""The terms in a stack, summed along its first axis."""

import numpy as np


def variance(X, D, N, R):
    X = np.asarray(X, float)
    terms = np.stack([X / N, np.full(X.shape, R**2 / N**2), np.power(D, 2) * (1 / 12)])
    return terms.sum(axis=0)
