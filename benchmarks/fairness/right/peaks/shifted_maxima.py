"""The maximum of 25 shifted copies."""

import numpy as np


def peaks(c, count):
    H, W = c.shape
    p = np.full((H + 4, W + 4), -np.inf)
    p[2:-2, 2:-2] = c
    top = np.max([p[dy : dy + H, dx : dx + W] for dy in range(5) for dx in range(5)], axis=0)
    y, x = np.where((c == top) & (c > 0))
    triples = sorted(zip(c[y, x], y, x), key=lambda t: -t[0])[:count]
    return np.array([(i - H // 2, j - W // 2) for _, i, j in triples])
