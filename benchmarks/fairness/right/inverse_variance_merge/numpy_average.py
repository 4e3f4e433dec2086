"""numpy's own weighted mean, with the sum of the weights that it returns."""

import numpy as np


def noise(light, D, N, R):
    return light / N + np.square(R / N) + np.square(D) / 12


def inverse_variance_merge(X, D, measured, t, N, R):
    seconds = np.ones_like(X) * np.asarray(t)[:, None, None]
    answers, light = X / seconds, X
    for _ in range(3):
        w = np.where(measured, seconds**2 / noise(light, D, N, R), 0)
        E, total = np.average(answers, axis=0, weights=w, returned=True)
        light = E * seconds
    return [E, total**-0.5]
