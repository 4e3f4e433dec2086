"""The difference to a blurred photo is doubled."""

import numpy as np
from scipy.ndimage import uniform_filter1d


def sharpen(y, h):
    m = len(h)
    sharp = 2 * y - uniform_filter1d(y, 5, axis=0)
    return sharp[m // 2 : m // 2 + len(y) - m + 1] * m / np.sum(h)
