import numpy as np


def compress(base, low, high, *, contrast=50.0):
    spread = high - low
    factor = 1.0
    if spread > 0:
        factor = min(1.0, np.log10(contrast) / spread)
    return (base - high) * factor
