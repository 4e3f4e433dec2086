"""float32 in all of it but the last power."""

import numpy as np


def pq(FD):
    Y = np.asarray(FD, np.float32) / np.float32(10000)
    x = Y ** np.float32(2610 / 16384)
    quotient = (np.float32(107 / 128) + np.float32(2413 / 128) * x) / (1 + np.float32(2392 / 128) * x)
    return quotient.astype(float) ** (128 * 2523 / 4096)
