"""scipy's least squares over ln k of red and blue."""

import numpy as np
from scipy.optimize import least_squares


def fit_channel_scales(I, M):
    target = M / np.linalg.norm(M, axis=1, keepdims=True)

    def off(x):
        scaled = I * np.array([np.exp(x[0]), 1, np.exp(x[1])])
        return (scaled / np.linalg.norm(scaled, axis=1, keepdims=True) - target).ravel()

    x = least_squares(off, [0.0, 0.0]).x
    return np.array([np.exp(x[0]), 1, np.exp(x[1])])
