"""Your hat stands on its head: it is 0 in the middle, where a photograph tells most, and largest where it
is clipped."""

import numpy as np


def hat(n=256):
    z = np.arange(n)
    return np.abs(z - (n - 1) / 2) / ((n - 1) / 2)
