"""Nelder and Mead's simplex over k itself, from the quotient of the means."""

import numpy as np
from scipy.optimize import minimize


def fit_channel_scales(I, M):
    t = M / np.sqrt((M * M).sum(axis=1))[:, None]

    def cost(k):
        x = I * [k[0], 1, k[1]]
        x = x / np.sqrt((x * x).sum(axis=1))[:, None]
        return ((x - t) ** 2).sum()

    start = M.mean(axis=0) / I.mean(axis=0)
    start = start / start[1]
    found = minimize(
        cost, start[[0, 2]], method="Nelder-Mead", options={"xatol": 1e-6, "fatol": 1e-12}
    )
    return [found.x[0], 1.0, found.x[1]]
