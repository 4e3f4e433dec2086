"""You added 1, so that clipped levels still count: a pixel of level 255 says only that there was at least
so much light."""

import numpy as np


def hat(n=256):
    z = np.arange(n)
    return np.minimum(z + 1, n - z) / (n // 2)
