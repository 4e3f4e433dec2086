"""Floats stay of their own type (float32 stays float32), masks by multiplication; no copy of the pairs."""

import numpy as np


def ratio_steps(found, *, limit=9.0, tolerance=1e-06, rounds=100):
    """Yield (k, used, V) of all pairs, and after each round; found = (x, y, v)."""
    x, y, v = (np.asarray(a) for a in found)
    kind = np.result_type(x, y, v)
    if not np.issubdtype(kind, np.floating):
        kind = np.float64
    x, y, v = x.astype(kind), y.astype(kind), v.astype(kind)
    vx, vy = v * x, v * y
    used = np.ones(len(x), bool)
    k = None
    for _ in range(rounds + 1):
        before = k
        k = np.dot(used * vx, vy) / np.dot(used * vx, vx)
        errors = (v * (y - k * x)) ** 2
        V = (used * errors).sum() / np.count_nonzero(used)
        yield float(k), used, float(V)
        if before is not None and abs(k - before) < tolerance:
            return
        used = errors <= limit * V
