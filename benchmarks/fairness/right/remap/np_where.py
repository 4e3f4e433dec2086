"""Both curves computed everywhere, np.where for the case and once more for the sign."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    lL = np.asarray(lL, dtype=float)
    d = np.abs(lL - g)
    far = np.where(d <= sigma, sigma * (d / sigma) ** alpha, sigma + beta * (d - sigma))
    return np.where(lL >= g, g + far, g - far)
