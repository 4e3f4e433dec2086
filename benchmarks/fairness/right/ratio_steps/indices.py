"""Indices of the pairs in use; masked arrays for the sums."""

import numpy as np


def ratio_steps(found, *, limit=9.0, tolerance=1e-6, rounds=100):
    x, y, v = map(np.asarray, found)
    keep = np.arange(x.size)
    k = None
    for n in range(rounds + 1):
        old = k
        w = v[keep] ** 2
        k = np.einsum("i,i,i", w, x[keep], y[keep]) / np.einsum("i,i,i", w, x[keep], x[keep])
        square = (v * (y - k * x)) ** 2
        V = square[keep].mean()
        used = np.zeros(x.size, bool)
        used[keep] = True
        yield k, used, V
        if n and abs(k - old) < tolerance:
            break
        keep = np.nonzero(square <= limit * V)[0]
