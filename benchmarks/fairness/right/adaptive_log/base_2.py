"""Logarithms to base 2 everywhere."""

import numpy as np


def adaptive_log(L, Lwa, Lmax, *, bias=0.85):
    x = np.asarray(L, float) / Lwa
    exponent = -np.log2(bias)
    base = 2 + 8 * np.power(np.asarray(L) / Lmax, exponent)
    scale = np.log2(10) / np.log2(Lmax / Lwa + 1)
    return np.log2(x + 1) / np.log2(base) * scale
