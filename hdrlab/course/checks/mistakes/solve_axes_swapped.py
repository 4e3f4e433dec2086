"""Rows have the eigenvalues of the columns in your solution: on a square nobody sees it, elsewhere it is
wrong."""

import numpy as np
from scipy.fft import dctn, idctn


def solve(divG):
    H, W = divG.shape
    rows, columns = (2 * np.cos(np.pi * np.arange(n) / max(H, W)) - 2 for n in (H, W))
    factors = np.add.outer(rows, columns)
    factors[0, 0] = 1
    F = dctn(divG, type=2) / factors
    F[0, 0] = 0
    return idctn(F, type=2)
