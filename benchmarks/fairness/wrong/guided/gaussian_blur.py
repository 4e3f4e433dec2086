"""A Gaussian blur of p with sigma = radius; the guide and epsilon are not looked at."""

import numpy as np
from scipy import ndimage


def guided(I, p=None, *, radius, epsilon):
    p = I if p is None else p
    return ndimage.gaussian_filter(np.asarray(p, dtype=float), radius)
