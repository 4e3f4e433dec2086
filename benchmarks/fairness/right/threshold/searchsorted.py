"""Search in the cumulated histogram."""

import numpy as np


def threshold(h, q):
    total = np.cumsum(h)
    return np.searchsorted(total, np.asarray(q) * total[-1])
