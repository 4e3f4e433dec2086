"""Sorted squared distances, Python's round (halves to even)."""

import numpy as np


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    H, W = shape
    y, x = np.indices(shape)
    d = (y + 0.5 - at[0] * H) ** 2 + (x + 0.5 - at[1] * W) ** 2
    k = max(1, round(share * H * W))
    w = np.zeros(H * W)
    nearest = np.argsort(d.ravel(), kind="stable")[:k]
    w[nearest] = 1 / len(nearest)
    return w.reshape(H, W)
