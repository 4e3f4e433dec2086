"""The smoothness rows have a weight too: lambda w(z) (g(z - 1) - 2 g(z) + g(z + 1)). Without w(z) the
ends are as stiff as the middle."""

import numpy as np

from hdrlab.response import debevec


def gsolve(Z, B, smoothness, w):
    A, b = debevec.system(Z, B, smoothness, w)
    n = len(w)
    for z, row in zip(range(1, n - 1), A[-(n - 2) :], strict=True):
        row[z - 1 : z + 2] = smoothness * np.array([1, -2, 1])
    x = np.linalg.lstsq(A, b, rcond=None)[0]
    return x[:n], x[n:]
