"""numpy.piecewise with four pieces, from below to above."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    x = np.asarray(lL, float)
    below, above = x < g - sigma, x > g + sigma
    low, high = (x < g) & ~below, (x >= g) & ~above
    pieces = [
        lambda v: g - (sigma + beta * (g - v - sigma)),
        lambda v: g - sigma * ((g - v) / sigma) ** alpha,
        lambda v: g + sigma * ((v - g) / sigma) ** alpha,
        lambda v: g + (sigma + beta * (v - g - sigma)),
    ]
    return np.piecewise(x, [below, low, high, above], pieces)
