"""The base by np.interp between 2 and 10."""

import numpy as np


def adaptive_log(L, Lwa, Lmax, *, bias=0.85):
    L = np.array(L, dtype=np.float64)
    t = (L / Lmax) ** (np.log(bias) / np.log(0.5))
    base = np.interp(t, [0, 1], [2, 10])
    return np.log(L / Lwa + 1) / np.log(base) / np.log10(1 + Lmax / Lwa)
