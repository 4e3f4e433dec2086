"""The text as it stands."""

import numpy as np


def adaptive_log(L, Lwa, Lmax, *, bias=0.85):
    Lw = L / Lwa
    Lwmax = Lmax / Lwa
    B = 2 + 8 * (Lw / Lwmax) ** (np.log(bias) / np.log(0.5))
    return (np.log(Lw + 1) / np.log(B)) / np.log10(Lwmax + 1)
