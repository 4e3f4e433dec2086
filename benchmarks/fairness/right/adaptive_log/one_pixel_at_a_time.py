"""A loop over all pixels, with the math module."""

import math

import numpy as np


def adaptive_log(L, Lwa, Lmax, *, bias=0.85):
    out = np.zeros(np.shape(L))
    p = math.log(bias) / math.log(0.5)
    for index, value in np.ndenumerate(L):
        base = 2 + 8 * (value / Lmax) ** p
        out[index] = math.log(value / Lwa + 1, base)
    return out / math.log10(Lmax / Lwa + 1)
