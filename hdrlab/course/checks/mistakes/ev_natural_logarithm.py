"""Stops are powers of two: take the logarithm to the base 2, where you took the natural one."""

import numpy as np


def ev(F, T, *, S=100.0):
    return 2 * np.log(F) - np.log(T) - np.log(S / 100)
