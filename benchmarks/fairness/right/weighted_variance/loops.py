"""Pixel by pixel."""

import numpy as np


def weighted_variance(x, w):
    P, H, W = x.shape
    v = np.zeros((H, W))
    for i in range(H):
        for j in range(W):
            s = sum(w[:, i, j])
            if s == 0:
                continue
            m = sum(w[p, i, j] * x[p, i, j] for p in range(P)) / s
            v[i, j] = sum(w[p, i, j] * (x[p, i, j] - m) ** 2 for p in range(P)) / s
    return v
