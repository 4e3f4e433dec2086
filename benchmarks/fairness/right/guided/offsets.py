"""Sums over all offsets of a window; zeros past the edge, and no counts of what is there."""

import numpy as np


def mean(x, r):
    H, W = x.shape
    padded = np.pad(x, r)
    total = sum(padded[dy : dy + H, dx : dx + W] for dy in range(2 * r + 1) for dx in range(2 * r + 1))
    return total / (2 * r + 1) ** 2


def guided(I, p=None, *, radius, epsilon):
    p = I if p is None else p
    a = mean(I * p, radius) - mean(I, radius) * mean(p, radius)
    a = a / (mean(I**2, radius) - mean(I, radius) ** 2 + epsilon)
    b = mean(p, radius) - a * mean(I, radius)
    return mean(a, radius) * I + mean(b, radius)
