"""One power over the whole range, with no edge anywhere."""

import numpy as np


def remap(lL, g, *, sigma, alpha, beta):
    d = lL - g
    return g + np.sign(d) * np.abs(d) ** alpha
