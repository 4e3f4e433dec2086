"""Float64, vectorised generator, k = sum v^2 x y / sum v^2 x^2, plain tuples; lists are welcome."""

import numpy as np


def ratio_steps(found, *, limit=9.0, tolerance=1e-06, rounds=100):
    """Yield (k, used, V) of all pairs, and after each round; found = (x, y, v)."""
    x, y, v = (np.asarray(a, dtype=float) for a in found)

    def solve(used):
        X, Y, w2 = x[used], y[used], v[used] ** 2
        k = np.sum(w2 * X * Y) / np.sum(w2 * X * X)
        return k, np.mean(w2 * (Y - k * X) ** 2)

    used = np.ones(x.shape, dtype=bool)
    k, V = solve(used)
    yield k, used, V
    for _ in range(rounds):
        used = (v * (y - k * x)) ** 2 <= limit * V
        before = k
        k, V = solve(used)
        yield k, used, V
        if abs(k - before) < tolerance:
            break
