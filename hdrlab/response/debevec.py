"""The response curve by linear least squares (Debevec and Malik, SIGGRAPH 1997).

Z   pixel levels         (N, P) integers 0 ... n - 1: sample i in frame j
B   ln exposure times    (P,), ln seconds
w   weights              (n,), 0 where a level is not to be trusted
g   ln f^-1              (n,), ln exposure of each level, g[n // 2] = 0
lE  ln irradiance        (N,), ln of (exposure / second)
lambda                   `smoothness`, how stiff g is; its rows are multiplied by it, as in the listing

The camera makes Z_ij = f(E_i t_j), hence g(Z_ij) = lE_i + B_j [eq. 2]: every sample is the same
curve g, slid sideways by an unknown lE_i. Two frames of one sample connect two points of g; a few
hundred samples connect them all.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from hdrlab.core import sampling, weights
from hdrlab.core.arrays import F64, ArrayLike, Indices, as_stack, as_times, describe
from hdrlab.errors import InputError


class Solution(NamedTuple):
    """The curve, and each sample's ln irradiance, 0 for a sample without weight."""

    g: F64
    lE: F64


def samples_needed(frames: int, n: int = 256) -> int:
    """Return the smallest N with N (P - 1) > Zmax - Zmin [Debevec97 sec. 2.1].

    With fewer samples the system has more unknowns than equations.
    """
    return (n - 1) // (frames - 1) + 1


def system(Z: Indices, B: F64, smoothness: float, w: F64) -> tuple[F64, F64]:
    """Return A and b of the least-squares system A x = b, x = (g, lE) [Debevec97 eq. 3 and appendix].

    N P rows fit the data, w (g(Z_ij) - lE_i) = w B_j; one row says g(n // 2) = 0; n - 2 rows say
    that lambda w(z) g''(z) = 0.
    """
    N, P = Z.shape
    n = len(w)
    A = np.zeros((N * P + n - 1, n + N))
    b = np.zeros(N * P + n - 1)
    for k, (i, j) in enumerate(np.ndindex(N, P)):
        wij = w[Z[i, j]]
        A[k, Z[i, j]] = wij
        A[k, n + i] = -wij
        b[k] = wij * B[j]
    A[N * P, n // 2] = 1
    for z in range(1, n - 1):
        A[N * P + z, z - 1 : z + 2] = smoothness * w[z] * np.array([1, -2, 1])
    return A, b


def solve_by_svd(A: ArrayLike, b: ArrayLike, *, rtol: float = 1e-10) -> F64:
    """Return the shortest x that minimizes |A x - b|: sum of (u_i^T b / sigma_i) v_i, A = U Sigma V^T.

    Singular values up to rtol times the largest count as 0, and their terms are left out.

    Examples
    --------
    >>> solve_by_svd([[1, -1], [2, -2]], [2, 4]).round(6)  # x_0 - x_1 = 2, and no more is known
    array([ 1., -1.])
    """
    U, sigma, Vt = np.linalg.svd(np.asarray(A, np.float64), full_matrices=False)
    kept = sigma > rtol * sigma[0]
    return Vt[kept].T @ (U[:, kept].T @ b / sigma[kept])


def gsolve(Z: ArrayLike, B: ArrayLike, smoothness: float, w: ArrayLike) -> Solution:
    """Return the g and lE that minimize the sum of squares: the shortest x that minimizes |A x - b|.

    Parameters
    ----------
    Z : (N, P) integers
        Pixel levels, 0 to n - 1.
    B : (P,) float
        Natural logarithm of the exposure times in seconds.
    smoothness : float
        lambda; 10 to 100 for photos.
    w : (n,) float
        Weights. A level beyond a cut is in no equation; it takes the value of the nearest level
        that is in one.

    Returns
    -------
    (g, lE) : (n,) and (N,) float64
        The curve, g[n // 2] = 0, and the ln irradiance of each sample.

    Raises
    ------
    ValueError
        If the arrays do not fit together, or no sample is well exposed in two photos.

    References
    ----------
    Debevec and Malik, Recovering high dynamic range radiance maps from photographs, SIGGRAPH 1997,
    eq. 3.

    Examples
    --------
    >>> Z = np.array([[64, 128], [100, 200], [50, 100], [120, 240]])
    >>> hat = np.minimum(np.arange(256), np.arange(255, -1, -1)) / 127
    >>> g, lE = gsolve(Z, np.log([1, 2]), 10, hat)
    >>> bool(np.allclose(g[200] - g[100], np.log(2), atol=0.01))  # twice the light: ln 2 apart
    True
    """
    Z = np.asarray(Z)
    B = np.asarray(B, np.float64)
    w = np.asarray(w, np.float64)
    n = len(w)
    if Z.ndim != 2 or B.shape != Z.shape[1:] or not 0 <= Z.min() <= Z.max() < n:
        raise InputError(
            f"expected levels Z (N, P) below {n} and B (P,), got {describe(Z)} and {describe(B)}"
        )
    A, b = system(Z, B, smoothness, w)
    x, _, rank, _ = np.linalg.lstsq(A, b, rcond=None)
    if rank < np.count_nonzero(A.any(axis=0)):
        raise InputError("expected samples that are well exposed in two photos, got none")
    reached = np.flatnonzero(A[:, :n].any(axis=0))
    g = np.interp(np.arange(n), reached, x[reached])
    return Solution(g, np.asarray(x[n:]))


def recover(
    images: ArrayLike,
    times: ArrayLike,
    *,
    smoothness: float = 30.0,
    samples: int = 1000,
    w: ArrayLike | None = None,
    choose: Callable[..., Indices] = sampling.by_rank,
    valid: ArrayLike | None = None,
) -> F64:
    """Return the response g recovered from a bracket, each channel by itself.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Photographs; 16 bits are read at 256 levels.
    times : (P,) float
        Exposure times in seconds, at least two different ones.
    smoothness : float
        lambda of the paper.
    samples : int
        How many pixels to choose, N.
    w : (256,) float, optional
        Weights. The default is the geometric mean of hat and Gaussian: on the worst of 201 measured
        curves it errs less than either of them (on half of the curves the hat errs least). It is
        cut above 0.98 of the top level, where noise hides clipped pixels, and below 0.02, where
        noise is as large as the level.
    choose : function
        `sampling.by_rank` (default), `sampling.by_grid`, or your own with the same signature.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.

    Returns
    -------
    (256,) or (256, 3) float64
        g, the ln exposure of each level; g[128] = 0 in every channel: mid gray is assumed to be
        neutral.

    Raises
    ------
    ValueError
        For fewer than two photographs or two different times, and for photographs in which no
        pixel is well exposed twice.

    References
    ----------
    Debevec and Malik, SIGGRAPH 1997, eq. 3; Cerman and Hlavac 2006, sec. 4.2, for the cut.

    Examples
    --------
    >>> ramp = np.linspace(1, 100, 10_000).reshape(100, 100)  # a linear camera
    >>> images = np.clip(np.round(ramp * np.array([1, 2, 4])[:, None, None]), 0, 255).astype(np.uint8)
    >>> g = recover(images, [0.01, 0.02, 0.04])
    >>> bool(abs(g[200] - np.log(200 / 128)) < 0.01)
    True
    """
    stack = as_stack(images)
    B = np.log(as_times(times, len(stack), distinct=2))
    if w is None:
        w = weights.cut(np.sqrt(weights.hat() * weights.gaussian()), below=0.02)
    w = np.asarray(w, np.float64)
    Z = choose(stack, samples, valid=valid)
    curves = []
    for Z_channel in sampling.split_channels(Z):
        curves.append(gsolve(Z_channel, B, smoothness, w).g)
    g = straighten_toe(np.stack(curves, axis=-1), w)
    return weights.make_monotone(g).reshape(256, *stack.shape[3:])


def straighten_toe(g: F64, w: F64) -> F64:
    """Return g with f^-1 proportional to z + 1/2 below the first level that has a weight."""
    first = int(np.argmax(w > 0))
    toe = g[first] + np.log((np.arange(first) + 0.5) / (first + 0.5))[:, None]
    return np.concatenate([toe, g[first:]])
