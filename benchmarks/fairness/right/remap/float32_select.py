"""float32 throughout, with np.select over the four cases."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    l = np.asarray(lL, dtype=np.float32)
    g = np.asarray(g, dtype=np.float32)
    sigma, alpha, beta = np.float32(sigma), np.float32(alpha), np.float32(beta)
    d = np.abs(l - g)
    detail = sigma * (d / sigma) ** alpha
    if alpha < 1:
        y = np.clip(d / np.float32(0.01) - 1, 0, 1).astype(np.float32)
        tau = np.square(y * (2 - y))
        detail = tau * detail + (1 - tau) * d
    edge = sigma + beta * (d - sigma)
    near, above, below = d <= sigma, l > g, l < g
    return np.select(
        [near & above, near & below, above, below],
        [g + detail, g - detail, g + edge, g - edge],
        default=g,
    )
