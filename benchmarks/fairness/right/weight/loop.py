"""Pixel by pixel; pixels at the edge take weight 0."""

import math

import numpy as np


def weight(F, powers=(1, 1, 1)):
    _, H, W = np.shape(F)
    F = np.asarray(F, float).tolist()
    a, b, c = powers
    Y = [
        [0.299 * F[0][y][x] + 0.587 * F[1][y][x] + 0.114 * F[2][y][x] for x in range(W)]
        for y in range(H)
    ]
    out = np.zeros((H, W))
    for y in range(1, H - 1):
        for x in range(1, W - 1):
            C = abs(Y[y - 1][x] + Y[y + 1][x] + Y[y][x - 1] + Y[y][x + 1] - 4 * Y[y][x])
            v = [F[k][y][x] for k in range(3)]
            m = sum(v) / 3
            S = math.sqrt(sum((u - m) ** 2 for u in v) / 3)
            E = math.exp(-sum((u - 0.5) ** 2 for u in v) / (2 * 0.04))
            out[y, x] = C**a * S**b * E**c
    return out
