"""np.piecewise with three pieces over the ravelled differences, reshaped at the end."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    lL = np.asarray(lL, dtype=float)
    x = (lL - g).ravel()
    r = np.piecewise(
        x,
        [x < -sigma, x > sigma],
        [
            lambda t: -sigma + beta * (t + sigma),
            lambda t: sigma + beta * (t - sigma),
            lambda t: np.sign(t) * sigma * (np.abs(t) / sigma) ** alpha,
        ],
    )
    return r.reshape(lL.shape) + g
