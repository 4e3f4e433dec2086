"""You average pairs, then pairs of pairs, and cut the fraction off each time: every level is darker than the
last. Add all four, and round once."""

import numpy as np


def shrink(Y):
    Y = np.asarray(Y, int)[: len(Y) // 2 * 2, : Y.shape[1] // 2 * 2]
    rows = (Y[::2] + Y[1::2]) // 2
    return (rows[:, ::2] + rows[:, 1::2]) // 2
