"""k as the mean of y / x, weighted by v^2 x^2: the same sums."""

import numpy as np


def ratio_steps(found, *, limit=9.0, tolerance=1e-6, rounds=100):
    x, y, v = found
    weight, ratio = (v * x) ** 2, y / x
    used, k, V, left = np.ones(x.shape, bool), None, None, rounds
    while True:
        new = np.average(ratio[used], weights=weight[used])
        V = np.average((weight * (ratio - new) ** 2)[used])
        yield float(new), used, float(V)
        if left == 0 or (k is not None and abs(new - k) < tolerance):
            return
        k, left = new, left - 1
        used = weight * (ratio - k) ** 2 <= limit * V
