"""Pixel by pixel, a window of 6 around each."""

import math

import numpy as np


def fix_uncertain(mean, k, *, sigma_s):
    H, W = mean.shape
    reach = 6
    bell = [math.exp(-d * d / 8) for d in range(-reach, reach + 1)]
    weight = np.outer(bell, bell)
    padded = np.pad(mean.astype(float), reach, mode="symmetric")
    base = mean.astype(float).copy()
    limit = math.log(math.sqrt(2 * math.pi * sigma_s**2))
    for y in range(H):
        for x in range(W):
            u = min(max(math.log(k[y, x]) / limit, 0.0), 1.0)
            if u < 1:
                around = padded[y : y + 2 * reach + 1, x : x + 2 * reach + 1]
                base[y, x] = u * mean[y, x] + (1 - u) * (weight * around).sum() / weight.sum()
    return base
