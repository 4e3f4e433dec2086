"""Fills a dense A row by row as in the paper and calls np.linalg.lstsq; of two nearest the lower wins."""

from typing import NamedTuple

import numpy as np


class Solution(NamedTuple):
    """The curve, and each sample's ln irradiance, 0 for a sample without weight."""

    g: np.ndarray
    lE: np.ndarray


def _check(Z, B, w):
    if Z.ndim != 2 or B.ndim != 1 or w.ndim != 1 or Z.shape[1] != len(B):
        raise ValueError("Z must be (N, P), B (P,) and w (n,)")
    if Z.dtype.kind not in "iu" or Z.size == 0 or Z.min() < 0 or Z.max() >= len(w):
        raise ValueError("Z must hold levels from 0 to n - 1")
    for levels in Z:
        seen = B[w[levels] > 0]
        if len(seen) > 1 and seen.max() > seen.min():
            return
    raise ValueError("no sample is seen well in two different exposures")


def gsolve(Z, B, smoothness, w):
    Z, B, w = np.asarray(Z), np.asarray(B, dtype=float), np.asarray(w, dtype=float)
    _check(Z, B, w)
    (N, P), n = Z.shape, len(w)
    A = np.zeros((N * P + 1 + n - 2, n + N))
    b = np.zeros(len(A))
    k = 0
    for i in range(N):
        for j in range(P):
            wij = w[Z[i, j]]
            A[k, Z[i, j]] = wij
            A[k, n + i] = -wij
            b[k] = wij * B[j]
            k += 1
    A[k, n // 2] = 1
    k += 1
    for z in range(1, n - 1):
        A[k, z - 1 : z + 2] = smoothness * w[z] * np.array([1, -2, 1])
        k += 1
    x = np.linalg.lstsq(A, b, rcond=None)[0]
    g, lE = x[:n].copy(), x[n:]
    used = np.flatnonzero(np.any(A[:, :n] != 0, axis=0))
    for z in range(n):
        g[z] = x[used[np.argmin(np.abs(used - z))]]
    return Solution(g, lE)
