"""The weight multiplies the whole row: w (g - lE) = w B. Your right-hand side has no weight."""

import numpy as np

from hdrlab.response import debevec


def gsolve(Z, B, smoothness, w):
    A, b = debevec.system(Z, B, smoothness, w)
    b[: Z.size] = np.tile(B, len(Z))
    x = np.linalg.lstsq(A, b, rcond=None)[0]
    return x[: len(w)], x[len(w) :]
