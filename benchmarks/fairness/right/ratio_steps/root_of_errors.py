"""Compares roots: |v (y - k x)| with the root of limit V; sums as products of vectors."""

import numpy as np


def ratio_steps(found, *, limit=9.0, tolerance=1e-6, rounds=100):
    x, y, v = found
    vx, vy = v * x, v * y
    used = np.arange(len(x)) >= 0
    k = (vx @ vy) / (vx @ vx)
    V = np.var(vy - k * vx) + np.mean(vy - k * vx) ** 2
    states = [(k, used.copy(), V)]
    change, i = np.inf, 0
    while i < rounds and not change < tolerance:
        used = np.abs(vy - k * vx) <= np.sqrt(limit * V)
        a, b = vx[used], vy[used]
        change, k = abs(a @ b / (a @ a) - k), a @ b / (a @ a)
        V = np.dot(b - k * a, b - k * a) / used.sum()
        states.append((k, used.copy(), V))
        i += 1
    yield from states
