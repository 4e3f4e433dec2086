"""The smoothness row of level z is weighted by w(z), the level in its middle; you took the weight of a
neighbour."""

import numpy as np

from hdrlab.response import debevec


def gsolve(Z, B, smoothness, w):
    A, b = debevec.system(Z, B, smoothness, w)
    n = len(w)
    for z, row in zip(range(1, n - 1), A[-(n - 2) :], strict=True):
        row[z - 1 : z + 2] = smoothness * w[z + 1] * np.array([1, -2, 1])
    x = np.linalg.lstsq(A, b, rcond=None)[0]
    return x[:n], x[n:]
