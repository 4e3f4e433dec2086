"""np.partition finds the radius."""

import numpy as np


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    H, W = shape
    down = np.arange(H)[:, None] + 0.5 - at[0] * H
    right = np.arange(W) + 0.5 - at[1] * W
    d = np.sqrt(down**2 + right**2)
    k = int(share * H * W + 0.5) or 1
    inside = d <= np.partition(d.ravel(), k - 1)[k - 1]
    return inside / np.count_nonzero(inside)
