"""Rounds until E hardly changes, and the deviation of the last E."""

import numpy as np


def inverse_variance_merge(X, D, measured, t, N, R):
    t = np.reshape(t, (-1, 1, 1)).astype(float)
    x = np.where(measured, X / t, 0.0)

    def weights(light):
        V = light / N + (R / N) ** 2 + D * D / 12
        return measured * t**2 / V

    w = weights(X)
    E = (w * x).sum(axis=0) / w.sum(axis=0)
    for _ in range(50):
        before, w = E, weights(E * t)
        E = (w * x).sum(axis=0) / w.sum(axis=0)
        if np.max(np.abs(E / before - 1)) < 1e-9:
            break
    w = weights(E * t)
    return E, w.sum(axis=0) ** -0.5
