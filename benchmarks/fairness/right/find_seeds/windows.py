"""Sliding windows, and each good one stamped."""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view


def find_seeds(score):
    good = sliding_window_view(score, (3, 3)).min(axis=(2, 3)) > 1
    mask = np.zeros(score.shape, int)
    for dy in range(3):
        for dx in range(3):
            mask[dy : dy + good.shape[0], dx : dx + good.shape[1]] |= good
    return mask
