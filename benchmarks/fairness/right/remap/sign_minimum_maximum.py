"""No cases: the difference is split by minimum and maximum into a part up to sigma and a part beyond, both
added with np.sign."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    x = np.asarray(lL, dtype=float) - g
    d = np.abs(x)
    inside = np.minimum(d, sigma)
    beyond = np.maximum(d - sigma, 0.0)
    f = np.power(inside / sigma, alpha)
    if alpha < 1:
        y = np.minimum(np.maximum(100 * d - 1, 0), 1)
        tau = y * y * (2 - y) * (2 - y)
        f = tau * f + (1 - tau) * inside / sigma
    return g + np.sign(x) * (sigma * f + beta * beyond)
