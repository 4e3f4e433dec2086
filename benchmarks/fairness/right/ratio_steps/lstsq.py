"""numpy's least squares of v x k = v y."""

from typing import NamedTuple

import numpy as np


class State(NamedTuple):
    k: float
    used: np.ndarray
    V: float


def fit(a, b, used):
    k = float(np.linalg.lstsq(a[used, None], b[used], rcond=None)[0][0])
    return State(k, used, float(np.mean((b - k * a)[used] ** 2)))


def ratio_steps(found, *, limit=9.0, tolerance=1e-6, rounds=100):
    x, y, v = found
    a, b = v * x, v * y
    state = fit(a, b, np.full(len(x), True))
    yield state
    for _ in range(rounds):
        new = fit(a, b, (b - state.k * a) ** 2 <= limit * state.V)
        yield new
        done = abs(new.k - state.k) < tolerance
        state = new
        if done:
            return
