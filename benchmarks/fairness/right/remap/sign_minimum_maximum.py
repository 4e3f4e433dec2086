"""No cases: the difference is split by minimum and maximum into a part up to sigma and a part beyond, both
added with np.sign."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    x = np.asarray(lL, dtype=float) - g
    d = np.abs(x)
    inside = np.minimum(d, sigma)
    beyond = np.maximum(d - sigma, 0.0)
    return g + np.sign(x) * (sigma * np.power(inside / sigma, alpha) + beta * beyond)
