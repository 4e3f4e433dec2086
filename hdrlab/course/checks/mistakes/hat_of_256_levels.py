"""Your table has 256 levels whatever n says; photographs of 16 bits have 65536."""

import numpy as np


def hat(n=256):
    z = np.arange(n)
    return np.minimum(z, 255 - z).clip(0) / 127
