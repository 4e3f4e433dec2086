"""The result is cut to the display at the end."""

import numpy as np


def adaptive_log(L, Lwa, Lmax, *, bias=0.85):
    Lw, Lwmax = L / Lwa, Lmax / Lwa
    power = np.exp(np.log(np.maximum(Lw / Lwmax, 1e-30)) * np.log(bias) / np.log(0.5))
    Ld = np.log(Lw + 1) / (np.log(2 + 8 * power) * np.log10(Lwmax + 1))
    return np.clip(Ld, 0, 1)
