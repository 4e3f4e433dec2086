"""Below and above the middle; not scaled."""

import numpy as np


def hat(n=256):
    z = np.arange(n, dtype=np.float32)
    return np.where(z <= (n - 1) / 2, z, n - 1 - z)
