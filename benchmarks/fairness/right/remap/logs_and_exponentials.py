"""The power as the exponential of alpha times a logarithm, with differences of zero left out of it."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    lL = np.asarray(lL, dtype=float)
    x = lL - g
    d = np.abs(x)
    differs = d > 0
    log_d = np.log(d, where=differs, out=np.full(d.shape, np.log(sigma)))
    log_s = np.log(sigma)
    detail = np.exp(log_s + alpha * (np.minimum(log_d, log_s) - log_s))
    if alpha < 1:
        y = np.clip((d - 0.01) / 0.01, 0, 1)
        keep = np.exp(2 * np.log(np.maximum(y * (2 - y), 1e-300)))
        detail = d + keep * (detail - d)
    r = np.copysign(detail, x)
    edge = d > sigma
    r[edge] = np.copysign(sigma + beta * (d[edge] - sigma), x[edge])
    r[~differs] = 0.0
    return r + g
