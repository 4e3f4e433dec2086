"""As the sheet says."""

import numpy as np


def ratio_steps(found, *, limit=9.0, tolerance=1e-6, rounds=100):
    x, y, v = found
    used = np.ones(len(x), bool)
    k = np.sum(v**2 * x * y) / np.sum(v**2 * x**2)
    V = np.mean((v * (y - k * x)) ** 2)
    yield k, used, V
    for _ in range(rounds):
        errors = (v * (y - k * x)) ** 2
        used = errors <= limit * V
        before = k
        k = np.sum((v**2 * x * y)[used]) / np.sum((v**2 * x**2)[used])
        V = np.mean((v * (y - k * x))[used] ** 2)
        yield k, used, V
        if abs(k - before) < tolerance:
            break
