"""Through the two ends."""

import numpy as np


def compress(base, low, high, *, contrast=50.0):
    c = min(np.log10(contrast), high - low)
    return c * ((np.asarray(base, np.float32) - low) / (high - low) - 1)
