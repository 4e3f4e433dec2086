"""The sum of squares is minimized over gamma; the best intercept is the mean of what is left."""

import numpy as np
from scipy.optimize import minimize_scalar


def fit_exponent(ladders, *, alpha=0.0):
    def cost(gamma):
        left = [
            np.log(series - alpha) - gamma * np.log(R) * np.arange(len(series))
            for series, R in ladders
        ]
        return sum(np.sum((one - one.mean()) ** 2) for one in left)

    return minimize_scalar(cost, bracket=(0.1, 2.0), tol=1e-10).x
