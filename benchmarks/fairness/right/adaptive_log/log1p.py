"""log1p, and float32 in the end."""

import numpy as np


def adaptive_log(L, Lwa, Lmax, *, bias=0.85):
    peak = Lmax / Lwa
    base = 2.0 + 8.0 * (L / Lmax) ** (np.log(bias) / np.log(0.5))
    Ld = np.log1p(L / Lwa) / np.log(base) * np.log(10) / np.log1p(peak)
    return Ld.astype(np.float32)
