"""Leaves out the columns of g[n // 2] and of what no row uses; scipy.linalg.lstsq by gelsy."""

import numpy as np
from scipy import linalg


def _nearest(known, z):
    return min(known, key=lambda k: (abs(k - z), -k))


def gsolve(Z, B, smoothness, w):
    Z, B, w = np.asarray(Z), np.atleast_1d(np.asarray(B, float)), np.asarray(w, float)
    if Z.ndim != 2 or B.ndim != 1 or w.ndim != 1 or B.size != Z.shape[1] or w.size < 3:
        raise ValueError("need Z (N, P), B (P,), w (n,)")
    if not np.issubdtype(Z.dtype, np.integer):
        raise ValueError("levels must be integers")
    n, N = w.size, Z.shape[0]
    if Z.size == 0 or int(Z.max()) >= n or int(Z.min()) < 0:
        raise ValueError("levels must lie in 0 to n - 1")
    i, j = np.nonzero(w[Z])
    z = Z[i, j].astype(int)
    spans = [np.ptp(B[j[i == s]]) for s in np.unique(i)]
    if not spans or max(spans) == 0:
        raise ValueError("no sample is seen well in two different exposures")

    bends = [m for m in range(1, n - 1) if smoothness * w[m] != 0]
    A = np.zeros((z.size + len(bends), n + N))
    r = np.arange(z.size)
    A[r, z] = w[z]
    A[r, n + i] = -w[z]
    b = np.concatenate([w[z] * B[j], np.zeros(len(bends))])
    for row, m in enumerate(bends, start=z.size):
        A[row, [m - 1, m, m + 1]] = smoothness * w[m], -2 * smoothness * w[m], smoothness * w[m]

    in_rows = A.any(axis=0)
    free = in_rows.copy()
    free[n // 2] = False
    x = np.zeros(n + N)
    x[free] = linalg.lstsq(A[:, free], b, lapack_driver="gelsy")[0]
    known = sorted({*np.flatnonzero(in_rows[:n]).tolist(), n // 2})
    g = np.array([x[_nearest(known, m)] for m in range(n)])
    return g, x[n:]
