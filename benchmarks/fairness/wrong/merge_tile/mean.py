"""The mean of all frames, with ghosts."""

import numpy as np


def merge_tile(T, variance, *, tuning):
    return np.mean(T, axis=0)
