"""Cuts the last row and column off and pads zeros on both ends, so that all differences are alike."""

import numpy as np


def backward(steps, axis):
    inner = np.delete(steps, -1, axis=axis)
    ends = [(0, 0), (0, 0)]
    ends[axis] = (1, 1)
    padded = np.pad(inner, ends)
    n = padded.shape[axis]
    return padded.take(range(1, n), axis=axis) - padded.take(range(n - 1), axis=axis)


def divergence(G):
    G = np.asarray(G)
    return np.sum([backward(G[axis], axis) for axis in (0, 1)], axis=0)
