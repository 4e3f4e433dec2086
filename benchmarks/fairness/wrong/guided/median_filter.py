"""The median of p in each window; the guide and epsilon are not looked at."""

import numpy as np
from scipy import ndimage


def guided(I, p=None, *, radius, epsilon):
    p = I if p is None else p
    return ndimage.median_filter(np.asarray(p, dtype=float), size=2 * radius + 1)
