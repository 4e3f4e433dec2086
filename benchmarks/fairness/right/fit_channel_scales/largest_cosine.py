"""|a - b|^2 = 2 - 2 cos: the sum of the cosines is maximized by BFGS."""

import numpy as np
from scipy.optimize import minimize


def fit_channel_scales(I, M):
    def cosines(x):
        k = np.exp(np.array([x[0], 0, x[1]]))
        a = I * k
        return -((a * M).sum(1) / np.linalg.norm(a, axis=1) / np.linalg.norm(M, axis=1)).mean()

    x = minimize(cosines, np.zeros(2), options={"gtol": 1e-7}).x
    return np.exp(np.array([x[0], 0, x[1]]))
