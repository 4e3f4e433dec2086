"""Sums pairs of rows, then pairs of columns, in uint32; floor(mean + 1/2), dtype kept."""

import numpy as np


def _pairs(a, axis):
    half = a.shape[axis] // 2
    first = np.take(a, 2 * np.arange(half), axis=axis)
    second = np.take(a, 2 * np.arange(half) + 1, axis=axis)
    return first + second


def shrink(Y):
    total = _pairs(_pairs(Y.astype(np.uint32), 0), 1)
    return np.floor(total / 4 + 0.5).astype(Y.dtype)
