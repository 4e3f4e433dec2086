"""All pixels at most as far as the k-th nearest (equally near ones come along), weights by their number."""

import numpy as np


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    H, W = shape
    y, x = np.ogrid[0.5:H, 0.5:W]
    d = (y - at[0] * H) ** 2 + (x - at[1] * W) ** 2
    k = int(np.clip(np.rint(H * W * share), 1, H * W))
    inside = d <= np.sort(d, axis=None)[k - 1]
    return inside / inside.sum()
