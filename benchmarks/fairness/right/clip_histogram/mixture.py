"""A mixture of the cut histogram and the flat one at the limit."""

import numpy as np


def clip_histogram(h, *, limit=4.0):
    n = len(h)
    cut = np.clip(h, 0, limit / n)
    if limit <= 1:
        return np.full(n, 1 / n)
    t = (1 - cut.sum()) / (limit - cut.sum())
    return (1 - t) * cut + t * limit / n
