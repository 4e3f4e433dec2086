"""A pixel's middle taken at (y, x)."""

import numpy as np


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    H, W = shape
    y, x = np.indices(shape)
    d = (y - at[0] * H) ** 2 + (x - at[1] * W) ** 2
    k = max(1, round(share * H * W))
    w = np.zeros(H * W)
    w[np.argsort(d.ravel(), kind="stable")[:k]] = 1 / k
    return w.reshape(H, W)
