"""Red and blue in turn, each by a bounded search, until nothing moves."""

import numpy as np
from scipy.optimize import minimize_scalar


def fit_channel_scales(I, M):
    lengths = [sum(float(x) ** 2 for x in row) ** 0.5 for row in M]
    target = np.array([[x / length for x in row] for row, length in zip(M, lengths)])
    k = np.ones(3)
    for _ in range(60):
        for channel in (0, 2):

            def cost(ln, channel=channel):
                trial = k.copy()
                trial[channel] = np.exp(ln)
                a = I * trial
                return np.sum((a / np.sqrt(np.sum(a * a, 1))[:, None] - target) ** 2)

            middle = np.log(k[channel])
            ln = minimize_scalar(
                cost, bounds=(middle - 2, middle + 2), method="bounded", options={"xatol": 1e-9}
            ).x
            k[channel] = np.exp(ln)
    return k
