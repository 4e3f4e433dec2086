"""Signed 16-bit numbers before the difference, then np.abs."""

import numpy as np


def exclusion(Y, t):
    return np.abs(np.asarray(Y).astype(np.int16) - np.int16(t)) > 4
