"""A scene of less contrast than the display has is stretched: m is at most 1."""

import numpy as np


def compress(base, low, high, *, contrast=50.0):
    return np.log10(contrast) / (high - low) * (base - high)
