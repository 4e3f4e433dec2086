"""Counts the codes with fewer than q of the pixels at or below: their number is the answer."""

import numpy as np


def threshold(h, q):
    h = np.asarray(h)
    if h.sum() == 0:
        return np.zeros(np.shape(q), dtype=int)[()]
    running = np.cumsum(h)
    total = running[-1]
    too_low = running < np.expand_dims(np.asarray(q, dtype=float), -1) * total
    return np.clip(np.count_nonzero(too_low, axis=-1), 0, len(h) - 1)
