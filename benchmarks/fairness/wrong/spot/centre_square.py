"""A square about the place, of about the share."""

import numpy as np


def spot(shape, *, at=(0.5, 0.5), share=0.03):
    y, x = np.indices(shape) + 0.5
    half = (share * shape[0] * shape[1]) ** 0.5 / 2
    w = 1.0 * ((abs(y - at[0] * shape[0]) <= half) & (abs(x - at[1] * shape[1]) <= half))
    return w / w.sum()
