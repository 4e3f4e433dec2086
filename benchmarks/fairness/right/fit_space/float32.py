"""In float32, with scipy's eigenvalues by index."""

import numpy as np
from scipy.linalg import eigh


def fit_space(curves, count):
    mean = curves.mean(axis=0)
    X = curves - mean
    n = X.shape[1]
    values, vectors = eigh(X.T @ X / len(X), subset_by_index=[n - count, n - 1])
    H = vectors.T[::-1].astype(np.float32)
    return mean.astype(np.float32), H, np.sqrt(values[::-1]).astype(np.float32)
