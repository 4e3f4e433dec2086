"""c is a natural logarithm in your code and the base is in decades: the picture keeps 2.3 times too much
contrast."""

import numpy as np


def compress(base, low, high, *, contrast=50.0):
    return min(1.0, np.log(contrast) / (high - low)) * (base - high)
