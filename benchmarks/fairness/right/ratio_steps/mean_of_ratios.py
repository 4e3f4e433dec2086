"""The ratio as a weighted mean of the ratios y / x, where x is not 0, with weights (v x)^2; a
list; errors compared as |v (y - k x)| <= sqrt(limit V).
"""

import numpy as np


def ratio_steps(found, *, limit=9.0, tolerance=1e-06, rounds=100):
    """Yield (k, used, V) of all pairs, and after each round; found = (x, y, v)."""
    x, y, v = (np.array(a, dtype=float) for a in found)
    weight = (v * x) ** 2
    ratio = np.divide(y, x, out=np.zeros_like(y), where=x != 0)
    states = []
    used = np.ones_like(x, dtype=bool)
    while True:
        k = np.average(ratio[used], weights=weight[used])
        error = np.abs(v * (y - k * x))
        V = np.mean(error[used] ** 2)
        states.append((float(k), used.copy(), float(V)))
        if len(states) > 1 and abs(states[-1][0] - states[-2][0]) < tolerance:
            break
        if len(states) > rounds:
            break
        used = error <= np.sqrt(limit * V)
    return states
