"""The fraction of the room that is filled, found by halving."""

import numpy as np


def clip_histogram(h, *, limit=4.0):
    top = limit / len(h)
    cut = np.fmin(h, top)
    low, high = 0.0, 1.0
    for _ in range(60):
        t = (low + high) / 2
        if np.sum(cut + t * (top - cut)) < 1:
            low = t
        else:
            high = t
    return cut + low * (top - cut)
