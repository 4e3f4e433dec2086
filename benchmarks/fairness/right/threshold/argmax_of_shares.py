"""Compares running shares with q in a table (codes, q) and takes the first True; int for one share."""

import numpy as np


def threshold(h, q):
    h = np.asarray(h, dtype=float)
    shares = np.cumsum(h) / h.sum()
    q = np.asarray(q, dtype=float)
    enough = shares.reshape((-1,) + (1,) * q.ndim) >= q
    codes = np.argmax(enough, axis=0)
    return int(codes) if q.ndim == 0 else codes
