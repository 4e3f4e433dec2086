"""This is the mean, not the median: a few bright pixels pull it up, and no longer are half of the pixels
above it."""

import numpy as np


def threshold(h, q):
    return int(np.sum(np.arange(256) * h) / np.sum(h))
