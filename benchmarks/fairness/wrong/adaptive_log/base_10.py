"""Base 10 for all pixels."""

import numpy as np


def adaptive_log(L, Lwa, Lmax, *, bias=0.85):
    return np.log10(L / Lwa + 1) / np.log10(Lmax / Lwa + 1)
