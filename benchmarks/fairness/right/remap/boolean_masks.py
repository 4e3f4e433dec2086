"""Four boolean masks, above and below, detail and edge, each filled by itself; what equals g stays g."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    lL = np.asarray(lL, dtype=float)
    g = np.broadcast_to(np.asarray(g, dtype=float), lL.shape)
    d = np.abs(lL - g)
    r = g.copy()
    f = (d / sigma) ** alpha
    if alpha < 1:
        y = np.minimum(np.maximum(d / 0.01 - 1, 0), 1)
        tau = y**2 * (2 - y) ** 2
        f = tau * f + (1 - tau) * d / sigma
    detail, above = d <= sigma, lL > g
    below = lL < g
    m = detail & above
    r[m] += sigma * f[m]
    m = detail & below
    r[m] -= sigma * f[m]
    m = ~detail & above
    r[m] += sigma + beta * (d[m] - sigma)
    m = ~detail & below
    r[m] -= sigma + beta * (d[m] - sigma)
    return r
