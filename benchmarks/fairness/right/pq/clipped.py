"""Values cut to 0 ... 10,000 first, and the signal to 0 ... 1 last."""

import numpy as np

C1, C2, C3 = 0.8359375, 18.8515625, 18.6875


def pq(FD):
    Y = np.clip(np.asarray(FD, np.float64) / 1e4, 0, 1) ** (1305 / 8192)
    return np.clip(((C1 + C2 * Y) / (1 + C3 * Y)) ** (2523 / 32), 0, 1)
