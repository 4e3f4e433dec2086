"""Two masks, and the sign by comparison."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    d = np.abs(lL - g)
    r = np.empty(lL.shape)
    detail = d <= sigma
    r[detail] = sigma * (d[detail] / sigma) ** alpha
    r[~detail] = sigma + beta * (d[~detail] - sigma)
    return g + np.where(lL >= g, r, -r)
