"""Your weight is a ramp up to the top, so levels that are nearly clipped are trusted most. A hat falls to
both sides."""

import numpy as np


def hat(n=256):
    return np.arange(n) / (n - 1)
