"""Both curves computed everywhere, np.where for the case and once more for the sign."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    lL = np.asarray(lL, dtype=float)
    d = np.abs(lL - g)
    y = np.where(d < 0.01, 0, np.where(d > 0.02, 1, (d - 0.01) / 0.01))
    tau = np.where(alpha < 1, y**2 * (2 - y) ** 2, 1)
    near = sigma * (tau * (d / sigma) ** alpha + (1 - tau) * d / sigma)
    far = np.where(d <= sigma, near, sigma + beta * (d - sigma))
    return np.where(lL >= g, g + far, g - far)
