"""np.average where it can, 0 elsewhere."""

import numpy as np


def weighted_variance(x, w):
    some = w.any(axis=0)
    v = np.zeros(some.shape)
    xs, ws = x[:, some], w[:, some]
    m = np.average(xs, axis=0, weights=ws)
    v[some] = np.average((xs - m) ** 2, axis=0, weights=ws)
    return v
