"""The largest number spreads within the mask until nothing changes; ranks by unique."""

import numpy as np
from scipy import ndimage


def label(mask):
    mask = np.asarray(mask, bool)
    number = np.where(mask, np.arange(1, mask.size + 1).reshape(mask.shape), 0)
    while True:
        more = np.where(mask, ndimage.maximum_filter(number, 3, mode="constant"), 0)
        if np.array_equal(more, number):
            break
        number = more
    out = np.zeros(mask.shape, int)
    out[mask] = np.unique(number[mask], return_inverse=True)[1].reshape(-1) + 1
    return out
