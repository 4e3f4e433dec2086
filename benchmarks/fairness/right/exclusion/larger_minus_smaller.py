"""Stays in bytes: the larger minus the smaller never goes below zero."""

import numpy as np


def exclusion(Y, t):
    Y = np.asarray(Y, dtype=np.uint8)
    t = np.uint8(t)
    return np.greater(np.maximum(Y, t) - np.minimum(Y, t), 4)
