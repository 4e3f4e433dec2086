"""Eigenvectors of the covariance matrix, from the largest eigenvalue."""

import numpy as np


def fit_space(curves, count):
    C = np.cov(curves, rowvar=False, bias=True)
    values, vectors = np.linalg.eigh(C)
    order = np.argsort(values)[::-1][:count]
    return curves.mean(axis=0), vectors[:, order].T, np.sqrt(values[order])
