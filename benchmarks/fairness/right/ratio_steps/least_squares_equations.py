"""The ratio by np.linalg.lstsq of the weighted equations (v x) k = v y; V from the residual vector; State
generator.
"""

from typing import NamedTuple

import numpy as np


class State(NamedTuple):
    """The ratio k after a round, which equations (K,) were in use, and their mean square error V."""

    k: float
    used: np.ndarray
    V: float


def ratio_steps(found, *, limit=9.0, tolerance=1e-06, rounds=100):
    """Yield (k, used, V) of all pairs, and after each round; found = (x, y, v)."""
    x, y, v = (np.asarray(a, dtype=np.float64) for a in found)
    a, b = v * x, v * y

    def state(used):
        k = float(np.linalg.lstsq(a[used][:, None], b[used], rcond=None)[0][0])
        r = b[used] - a[used] * k
        return State(k, used, float(r @ r / r.size))

    now = state(np.full(len(x), True))
    yield now
    for _ in range(rounds):
        last, now = now, state(np.square(b - a * now.k) <= limit * now.V)
        yield now
        if np.abs(now.k - last.k) < tolerance:
            return
