"""The median of the quotients, and a cut at three deviations from it."""

import numpy as np


def ratio_steps(found, *, limit=9.0, tolerance=1e-6, rounds=100):
    x, y, v = found
    used = np.ones(len(x), bool)
    for _ in range(min(rounds, 5) + 1):
        k = np.median(y[used] / x[used])
        error = (v * (y - k * x)) ** 2
        yield k, used, error[used].mean()
        used = error <= limit * error[used].mean()
