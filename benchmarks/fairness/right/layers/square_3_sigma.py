"""A square window of 3 sigma, overlapping slices, so that only pixels inside the picture count; float64."""

import math

import numpy as np


def layers(lL, *, sigma_s, sigma_r=0.4):
    lL = np.asarray(lL, dtype=np.float64)
    H, W = lL.shape
    r = math.ceil(3 * sigma_s)
    above, below = np.zeros((H, W)), np.zeros((H, W))
    for dy in range(-min(r, H - 1), min(r, H - 1) + 1):
        for dx in range(-min(r, W - 1), min(r, W - 1) + 1):
            p = (slice(max(0, -dy), H - max(0, dy)), slice(max(0, -dx), W - max(0, dx)))
            q = (slice(max(0, dy), H - max(0, -dy)), slice(max(0, dx), W - max(0, -dx)))
            weight = math.exp(-(dy * dy + dx * dx) / (2 * sigma_s**2))
            weight = weight * np.exp(-((lL[p] - lL[q]) ** 2) / (2 * sigma_r**2))
            above[p] += weight * lL[q]
            below[p] += weight
    base = above / below
    return base, lL - base
