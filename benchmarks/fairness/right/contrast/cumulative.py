"""Smoothed by differences of the cumulative sum."""

import numpy as np


def contrast(block):
    I = np.zeros(256)
    np.add.at(I, block.astype(np.intp), 1)
    c = np.concatenate([[0, 0, 0], np.cumsum(I), [I.sum()] * 2])
    s = (c[5:] - c[:-5]) / 5
    p = s / s.sum()
    i = np.arange(256.0)
    above = i > i @ p
    # what lies above the mean and what lies below it are equally far from it
    return 2 * ((i - i @ p) * p)[above].sum()
