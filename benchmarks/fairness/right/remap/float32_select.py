"""float32 throughout, with np.select over the four cases."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    l = np.asarray(lL, dtype=np.float32)
    g = np.asarray(g, dtype=np.float32)
    sigma, alpha, beta = np.float32(sigma), np.float32(alpha), np.float32(beta)
    d = np.abs(l - g)
    detail = sigma * (d / sigma) ** alpha
    edge = sigma + beta * (d - sigma)
    near, above, below = d <= sigma, l > g, l < g
    return np.select(
        [near & above, near & below, above, below],
        [g + detail, g - detail, g + edge, g - edge],
        default=g,
    )
