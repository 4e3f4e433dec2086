"""numpy.ma's weighted average, photographs sorted by time; filled at the end."""

import numpy as np


def inverse_variance_merge(X, D, measured, t, N, R):
    order = np.argsort(t)
    m = np.asarray(measured)[order]
    t = np.asarray(t, float)[order][:, None, None]
    X = np.ma.array(np.where(m, np.asarray(X)[order], 1), mask=~m)
    D = np.ma.array(np.where(m, np.asarray(D)[order], 1), mask=~m)
    light = X
    for _ in range(3):
        V = (light / N + (R / N) ** 2 + D * D / 12) / (t * t)
        w = (1 / V).sum(axis=0)
        E = (X / t / V).sum(axis=0) / w
        light = np.ma.array(E[None] * t, mask=~m)
    return np.ma.filled(E, 0.0).astype(float), np.ma.filled(1 / np.ma.sqrt(w), np.inf).astype(float)
