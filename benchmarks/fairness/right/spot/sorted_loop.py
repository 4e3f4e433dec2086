"""All pixels are sorted by their distance, and the first ones taken."""

import math

import numpy as np


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    H, W = shape
    place = at[0] * H, at[1] * W
    near = sorted((math.dist((y + 0.5, x + 0.5), place), y, x) for y in range(H) for x in range(W))
    count = max(1, round(share * H * W))
    w = np.zeros((H, W))
    for _, y, x in near[:count]:
        w[y, x] = 1 / count
    return w
