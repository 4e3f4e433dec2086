"""Four boolean masks, above and below, detail and edge, each filled by itself; what equals g stays g."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    lL = np.asarray(lL, dtype=float)
    g = np.broadcast_to(np.asarray(g, dtype=float), lL.shape)
    d = np.abs(lL - g)
    r = g.copy()
    detail, above = d <= sigma, lL > g
    below = lL < g
    m = detail & above
    r[m] += sigma * (d[m] / sigma) ** alpha
    m = detail & below
    r[m] -= sigma * (d[m] / sigma) ** alpha
    m = ~detail & above
    r[m] += sigma + beta * (d[m] - sigma)
    m = ~detail & below
    r[m] -= sigma + beta * (d[m] - sigma)
    return r
