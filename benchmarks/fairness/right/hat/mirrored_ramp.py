"""Builds the rising half as a linspace from 0 to 1 and mirrors it, the odd middle once."""

import numpy as np


def hat(n=256):
    half = (n + 1) // 2
    if half < 2:
        return np.zeros(n)
    ramp = np.linspace(0.0, 1.0, half)
    return np.concatenate((ramp, ramp[::-1][n % 2 :]))
