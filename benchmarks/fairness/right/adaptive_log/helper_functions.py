"""The bias function and the logarithm to a base are functions of their own."""

import numpy as np


def bias_function(t, b):
    return t ** (np.log(b) / np.log(0.5))


def log_to_base(x, base):
    return np.log10(x) / np.log10(base)


def adaptive_log(L, Lwa, Lmax, *, bias=0.85):
    base = 2 + 8 * bias_function(L / Lmax, bias)
    return log_to_base(L / Lwa + 1, base) / np.log10(Lmax / Lwa + 1)
