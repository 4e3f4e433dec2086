"""A constant is added to all values."""

import numpy as np


def table(delta, *, a=1.79, c=0.192):
    return np.clip(np.arange(256) + round(40 * delta), 0, 255)
