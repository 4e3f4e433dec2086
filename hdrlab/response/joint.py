"""What samples say of a response, as one table over pairs of levels: joint histograms of the frames.

Z   pixel levels       (N, P) integers 0 ... n - 1: sample i in frame j
t   exposure times     (P,)
w   weights            (n,), 0 where a level is not to be trusted
f   f^-1               (n,), the exposure of each level
d   each sample's sum of w(Z_ij) t_j^2 over its frames, (N,)

Robertson's turn goes over all pixels twice, from f to irradiances and back. But it is linear in f, and what
it adds up for a level m of one frame and a level z of another is the same number in every turn. Summed once,
in the frames' joint histograms with weight 1 / d, it makes a turn a product with an (n, n) matrix, for a
thousand samples as for a million.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hdrlab.core.arrays import Array

Float = NDArray[np.float64]
BLOCK = 2**15  # samples at a time: their indices stay in the processor's cache


class Table(NamedTuple):
    """Sums over the samples that some frame shows well.

    S (n, n) of t_j t_k / d_i over Z_ij = m, Z_ik = z; pixels (n,) of each level; tied, whether one
    sample is seen well in two exposures, so that levels hang together at all.
    """

    S: Float
    pixels: NDArray[np.int64]
    tied: bool


def turned(f: Float, table: Table, w: Float) -> Float:
    """Return sum_z S(m, z) w(z) f(z) / |E_m|, what `robertson.update` makes of `robertson.irradiance`.

    0, not NaN, where E_m is empty.
    """
    return table.S @ (w * f) / np.maximum(table.pixels, 1)


def table(Z: Array, t: Float, w: Float) -> Table:
    """Return the Table of samples. S is symmetric, so a pair of frames is counted once."""
    n, P = len(w), Z.shape[1]
    pairs, own, pixels, tied = np.zeros(n * n), np.zeros(n), np.zeros(n, np.int64), False
    for start in range(0, len(Z), BLOCK):
        z = Z[start : start + BLOCK].T.astype(np.intp)
        d = t**2 @ w[z]
        z, d = (z, d) if d.all() else (z[:, d > 0], d[d > 0])
        tied = tied or in_two_exposures(z, t, w)
        pixels += np.bincount(z.ravel(), minlength=n)
        for j in range(P):
            own += np.bincount(z[j], t[j] ** 2 / d, n)
            row = z[j] * n
            for k in range(j):
                pairs += np.bincount(row + z[k], t[j] * t[k] / d, n * n)
    square = pairs.reshape(n, n)
    return Table(square + square.T + np.diag(own), pixels, tied)


def in_two_exposures(z: Array, t: Float, w: Float) -> bool:
    """Return whether a sample of z (P, N) has weight at two different times.

    Examples
    --------
    >>> in_two_exposures(np.array([[10], [80]]), np.array([1.0, 2.0]), np.ones(256))
    True
    """
    seen = (w > 0)[z]
    low, high = (way(np.where(seen, t[:, None], np.nan), axis=0) for way in (np.fmin.reduce, np.fmax.reduce))
    return bool(np.any(low < high))
