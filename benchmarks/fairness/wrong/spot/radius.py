"""A circle of the area share H W, which the picture's edge cuts off."""

import numpy as np


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    H, W = shape
    y, x = np.indices(shape)
    d = (y + 0.5 - at[0] * H) ** 2 + (x + 0.5 - at[1] * W) ** 2
    inside = (d <= share * H * W / np.pi) | (d == d.min())
    return inside / inside.sum()
