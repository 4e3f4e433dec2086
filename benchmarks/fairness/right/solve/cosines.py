"""By cosines, as the sheet says."""

import numpy as np
from scipy.fft import dctn, idctn


def solve(divG):
    H, W = divG.shape
    factor = (
        2 * np.cos(np.pi * np.arange(H) / H)[:, None] + 2 * np.cos(np.pi * np.arange(W) / W) - 4
    )
    factor[0, 0] = 1
    c = dctn(divG, type=2) / factor
    c[0, 0] = 0
    return idctn(c, type=2)
