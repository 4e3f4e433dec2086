"""numpy's SVD; a plain tuple."""

import numpy as np


def fit_space(curves, count):
    mean = curves.mean(axis=0)
    _, S, Vt = np.linalg.svd(curves - mean)
    return mean, Vt[:count], S[:count] / np.sqrt(curves.shape[0])
