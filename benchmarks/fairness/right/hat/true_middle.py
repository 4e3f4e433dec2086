"""The middle is (n - 1) / 2, where the line would reach 1: for 256 levels the largest is 127 / 127.5."""

import numpy as np


def hat(n=256):
    middle = (n - 1) / 2
    z = np.arange(n)
    w = np.where(z <= middle, z, n - 1 - z)
    return w / middle if middle > 0 else np.ones(n)
