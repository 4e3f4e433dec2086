"""Eigenvectors of the C x C matrix of inner products, carried over to the places."""

import numpy as np


def fit_space(curves, count):
    mean = np.mean(curves, axis=0)
    X = curves - mean
    values, U = np.linalg.eigh(X @ X.T)
    U, values = U[:, ::-1][:, :count], values[::-1][:count]
    H = (X.T @ U / np.sqrt(values)).T
    return mean, H, np.sqrt(values / len(curves))
