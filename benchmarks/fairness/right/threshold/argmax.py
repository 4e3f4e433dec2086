"""The first code whose share reaches q."""

import numpy as np


def threshold(h, q):
    share = np.cumsum(h) / np.sum(h)
    if np.ndim(q) == 0:
        return int(np.argmax(share >= q))
    return np.array([int(np.argmax(share >= one)) for one in q])
