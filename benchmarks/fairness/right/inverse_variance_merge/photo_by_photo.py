"""Two running sums over the photographs, s of the last V, and E NaN where nothing measures."""

import numpy as np


def inverse_variance_merge(X, D, measured, t, N, R):
    shape = X.shape[1:]
    E = None
    for _ in range(3):
        above, below = np.zeros(shape), np.zeros(shape)
        for k in range(len(t)):
            m = measured[k]
            x, d = X[k][m].astype(float), D[k][m]
            light = x if E is None else E[m] * t[k]
            V = (light / N + (R / N) ** 2 + d**2 / 12) / t[k] ** 2
            above[m] += x / t[k] / V
            below[m] += 1 / V
        E = np.full(shape, np.nan)
        some = below > 0
        E[some] = above[some] / below[some]
    s = np.full(shape, np.inf)
    s[some] = 1 / np.sqrt(below[some])
    return E, s
