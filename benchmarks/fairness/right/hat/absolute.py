"""By the distance to the middle."""

import numpy as np


def hat(n=256):
    middle = (n - 1) / 2
    return 1 - np.abs(np.arange(n) - middle) / middle
