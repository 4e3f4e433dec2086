"""The level of B that holds the rank, by searchsorted, and the share of it that is reached."""

import numpy as np


def brightness_transfer(h_A, h_B):
    h_A, h_B = np.asarray(h_A, float), np.asarray(h_B, float)
    n = h_A.size
    rank = (np.cumsum(h_A) - h_A / 2) / h_A.sum()
    p = h_B / h_B.sum()
    top = np.cumsum(p)
    z = np.minimum(np.searchsorted(top, rank, side="left"), n - 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.where(p[z] > 0, (rank - (top[z] - p[z])) / p[z], 1.0)
    T = z - 0.5 + part
    return np.where((T >= 0.5) & (T <= n - 1.5), T, np.nan)
