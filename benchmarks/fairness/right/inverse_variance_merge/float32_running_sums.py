"""Single precision, photograph by photograph, two sums that run."""

import numpy as np


def inverse_variance_merge(X, D, measured, t, N, R):
    E = None
    for _ in range(3):
        above = np.zeros(X.shape[1:], np.float32)
        below = np.zeros(X.shape[1:], np.float32)
        for x, d, seen, u in zip(X, D, measured, t, strict=True):
            light = x if E is None else E * np.float32(u)
            V = np.float32(light / N + (R / N) ** 2 + d**2 / 12)
            below += np.where(seen, np.float32(u**2) / V, 0)
            above += np.where(seen, np.float32(u) * np.float32(x) / V, 0)
        E = above / below
    return E, 1 / np.sqrt(below)
