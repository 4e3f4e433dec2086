"""Of a level stretch that has the rank the middle: mean of first and last place, exact integers."""

import numpy as np


def brightness_transfer(h_A, h_B):
    a, b = np.asarray(h_A).astype(np.int64), np.asarray(h_B).astype(np.int64)
    n = len(a)
    H_A, H_B = np.r_[0, a.cumsum()], np.r_[0, b.cumsum()]
    rank, H = (H_A[:-1] + H_A[1:]) * H_B[-1], 2 * H_B * H_A[-1]
    left, right = np.searchsorted(H, rank, "left"), np.searchsorted(H, rank, "right")
    T = np.empty(n)
    for m in range(n):
        if right[m] > left[m]:
            T[m] = (left[m] + right[m] - 1) / 2 - 0.5
        else:
            z = left[m] - 1
            T[m] = z - 0.5 + (rank[m] - H[z]) / (H[z + 1] - H[z])
    T[(T < 0.5) | (T > n - 1.5)] = np.nan
    return T
