"""Walks up the codes in plain Python until enough pixels are counted; one share after the other."""

import numpy as np


def _lowest(h, share):
    wanted = share * sum(h)
    seen = 0
    for code, pixels in enumerate(h):
        seen += pixels
        if seen >= wanted:
            return code
    return len(h) - 1


def threshold(h, q):
    h = [int(x) for x in h]
    if np.ndim(q) == 0:
        return _lowest(h, float(q))
    q = np.asarray(q)
    return np.array([_lowest(h, float(share)) for share in q.flat], dtype=np.int64).reshape(q.shape)
