"""Plain Python loops and floats, pair by pair; returns a list of States; no pair left gives nan, and the
end.
"""

import math
from typing import NamedTuple

import numpy as np


class State(NamedTuple):
    """The ratio k after a round, which equations (K,) were in use, and their mean square error V."""

    k: float
    used: np.ndarray
    V: float


def ratio_steps(found, *, limit=9.0, tolerance=1e-06, rounds=100):
    """Yield (k, used, V) of all pairs, and after each round; found = (x, y, v)."""
    x = [float(a) for a in found[0]]
    y = [float(a) for a in found[1]]
    v = [float(a) for a in found[2]]
    K = len(x)

    def solve(used):
        top = bottom = 0.0
        for i in range(K):
            if used[i]:
                top += (v[i] * x[i]) * (v[i] * y[i])
                bottom += (v[i] * x[i]) ** 2
        k = top / bottom if bottom > 0 else math.nan
        total, n = 0.0, 0
        for i in range(K):
            if used[i]:
                total += (v[i] * (y[i] - k * x[i])) ** 2
                n += 1
        return State(k, np.array(used, dtype=bool), total / n if n else math.nan)

    states = [solve([True] * K)]
    done = 0
    while done < rounds:
        last = states[-1]
        used = [(v[i] * (y[i] - last.k * x[i])) ** 2 <= limit * last.V for i in range(K)]
        states.append(solve(used))
        done += 1
        if abs(states[-1].k - last.k) < tolerance or math.isnan(states[-1].k):
            break
    return states
