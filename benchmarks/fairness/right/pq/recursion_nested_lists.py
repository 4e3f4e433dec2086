"""Recursion down the axes to single numbers with math.pow; the result is nested lists of that shape."""

import math

import numpy as np


def pq(FD):
    if np.ndim(FD) > 0:
        return [pq(part) for part in FD]
    Y = math.pow(float(FD) / 10_000, 2610 / 16384)
    above = 3424 / 4096 + 32 * 2413 / 4096 * Y
    below = 1 + 32 * 2392 / 4096 * Y
    return math.pow(above / below, 128 * 2523 / 4096)
