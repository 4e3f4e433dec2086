"""Longdouble sums and np.where; lists and integers are welcome; an empty round (no pair, or only x = 0)
keeps the last state and ends.
"""

import numpy as np


def ratio_steps(found, *, limit=9.0, tolerance=1e-06, rounds=100):
    """Yield (k, used, V) of all pairs, and after each round; found = (x, y, v)."""
    x, y, v = np.array([np.asarray(a, dtype=np.float64) for a in found]).astype(np.longdouble)

    def fit(used):
        w = np.where(used, v, 0)
        k = ((w * y) * (w * x)).sum() / ((w * x) ** 2).sum()
        V = ((w * (y - k * x)) ** 2).sum() / used.sum()
        return k, V

    used = np.ones(x.shape, dtype=bool)
    k, V = fit(used)
    yield float(k), used, float(V)
    change, count = np.inf, 0
    while not change < tolerance and count < rounds:
        used = (v * (y - k * x)) ** 2 <= limit * V
        if not np.any(used & (v * x != 0)):
            return
        new, V = fit(used)
        change, k = abs(new - k), new
        count += 1
        yield float(k), used, float(V)
