"""The sheet's formulas, with infinities at the ends."""

import numpy as np


def table(delta, *, a=1.79, c=0.192):
    with np.errstate(all="ignore"):
        q = -np.log((255 / np.arange(256.0)) ** (1 / c) - 1) / a
        Y = 255 / (1 + np.exp(-a * (q + delta))) ** c
    return np.rint(Y).astype(int)
