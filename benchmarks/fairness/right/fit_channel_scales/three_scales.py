"""All three scales are free, and divided by that of green at the end; a column is the answer."""

import numpy as np
from scipy.optimize import least_squares


def direction(x):
    return x / np.linalg.norm(x, axis=-1, keepdims=True)


def fit_channel_scales(I, M):
    def off(x):
        return (direction(I * np.exp(x)) - direction(M)).ravel()

    k = np.exp(least_squares(off, np.zeros(3), xtol=1e-12).x)
    return (k / k[1]).astype(np.float32).reshape(3, 1)
