"""Ordinary histogram matching: cumulative counts at whole levels, no middle rank."""

import numpy as np


def brightness_transfer(h_A, h_B):
    n = len(h_A)
    T = np.interp(np.cumsum(h_A) / np.sum(h_A), np.cumsum(h_B) / np.sum(h_B), np.arange(n))
    return np.where((T < 0.5) | (T > n - 1.5), np.nan, T)
