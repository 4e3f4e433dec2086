"""The response curve by linear least squares (Debevec and Malik, SIGGRAPH 1997).

Z   pixel levels         (N, P) integers 0 ... n - 1: sample i in frame j
B   ln exposure times    (P,), ln seconds
w   weights              (n,), 0 where a level is not to be trusted
g   ln f^-1              (n,), ln exposure of each level, g[n // 2] = 0
lE  ln irradiance        (N,), ln of (exposure / second)
lambda                   `smoothness`, how stiff g is; its rows are multiplied by it, as in the listing

The camera makes Z_ij = f(E_i t_j), hence g(Z_ij) = lE_i + B_j [eq. 2]: every sample is the same curve g, slid
sideways by an unknown lE_i. Two frames of one sample tie two points of g together; a few hundred samples tie
them all.
"""

from collections.abc import Callable
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core import weights
from hdrlab.core.arrays import as_stack, as_table, as_times, describe
from hdrlab.core.sampling import by_rank
from hdrlab.core.weights import make_monotone

Float = NDArray[np.float64]


class Solution(NamedTuple):
    """The system's answer: the curve, and each sample's ln irradiance, 0 for one that no frame saw well."""

    g: Float
    lE: Float


def samples_needed(frames: int, n: int = 256) -> int:
    """Return the least N with N (P - 1) > Zmax - Zmin: more equations than unknowns [Debevec97 sec. 2.1]."""
    return (n - 1) // (frames - 1) + 1


def system(Z: ArrayLike, B: ArrayLike, smoothness: float, w: ArrayLike) -> tuple[Float, Float]:
    """Return A and b of the least-squares system A x = b, x = (g, lE) [Debevec97 eq. 3 and appendix].

    N P rows fit the data, w (g(Z_ij) - lE_i) = w B_j; one row says g(n // 2) = 0; n - 2 rows say that
    lambda w(z) g''(z) = 0.
    """
    Z, B, w = _checked(Z, B, smoothness, w)
    (N, P), n = Z.shape, len(w)
    A, b = np.zeros((N * P + 1 + n - 2, n + N)), np.zeros(N * P + 1 + n - 2)
    k = 0
    for i in range(N):
        for j in range(P):
            wij = w[Z[i, j]]
            A[k, Z[i, j]], A[k, n + i], b[k] = wij, -wij, wij * B[j]
            k += 1
    A[k, n // 2] = 1
    k += 1
    for z in range(1, n - 1):
        A[k, z - 1 : z + 2] = smoothness * w[z] * np.array([1, -2, 1])
        k += 1
    return A, b


def gsolve_svd(Z: ArrayLike, B: ArrayLike, smoothness: float, w: ArrayLike) -> Solution:
    """Return the shortest x that minimises |A x - b|: x = V S^+ U^T b, with the SVD of A = U S V^T."""
    A, b = system(Z, B, smoothness, w)
    x = np.asarray(np.linalg.lstsq(A, b, rcond=None)[0], np.float64)
    n = len(np.asarray(w))
    return Solution(x[:n], x[n:])


def gsolve(Z: ArrayLike, B: ArrayLike, smoothness: float, w: ArrayLike) -> Solution:
    """Return the same least-squares solution from n unknowns instead of n + N.

    For a given g each sample's best lE_i is a weighted mean, sum_j w^2 (g(Z_ij) - B_j) / sum_j w^2. Put into
    the normal equations it leaves a system S g = r in g alone (a Schur complement). The table C (N, n) holds
    the squared weights: C[i, z] is the sum of w^2 over the frames where sample i has level z.

    Parameters
    ----------
    Z : (N, P) integers
        Pixel levels, 0 to n - 1.
    B : (P,) float
        Natural logarithm of the exposure times in seconds.
    smoothness : float
        lambda; 10 to 100 for photographs.
    w : (n,) float
        Weights. Levels that no equation reaches, those beyond a cut, take the nearest reached one's value.

    Returns
    -------
    Solution
        g (n,) with g[n // 2] = 0 exactly, and lE (N,).

    Raises
    ------
    ValueError
        If the arrays do not fit together, or no sample is seen well in two different exposures.

    References
    ----------
    Debevec and Malik, Recovering high dynamic range radiance maps from photographs, SIGGRAPH 1997, eq. 3.

    Examples
    --------
    >>> Z = np.array([[64, 128], [100, 200], [50, 100], [120, 240]])
    >>> g, lE = gsolve(Z, np.log([1, 2]), 10, weights.hat())
    >>> bool(np.allclose(g[200] - g[100], np.log(2), atol=0.01))  # twice the light: ln 2 apart
    True
    """
    Z, B, w = _checked(Z, B, smoothness, w)
    N, n = len(Z), len(w)
    W = w[Z] ** 2
    _require_two_exposures(W, B)
    D = W.sum(axis=1)  # what multiplies lE_i in its own normal equation
    seen = D > 0
    D[~seen] = 1
    C = np.zeros((N, n))
    np.add.at(C, (np.arange(N)[:, None], Z), W)
    WB = W * B
    S = np.diag(C.sum(axis=0)) - C.T @ (C / D[:, None]) + _stiffness(w, smoothness)
    r = np.bincount(Z.ravel(), WB.ravel(), n) - C.T @ (WB.sum(axis=1) / D)
    g = _solve_with_gauge(S, r)
    return Solution(g, np.where(seen, (C @ g - WB.sum(axis=1)) / D, 0.0))


def _stiffness(w: Float, smoothness: float) -> Float:
    """Return the sum over z of (lambda w(z))^2 d d^T, d = (1, -2, 1) at z - 1, z, z + 1."""
    S, z = np.zeros((len(w), len(w))), np.arange(1, len(w) - 1)
    for (a, da), (b, db) in product(((-1, 1), (0, -2), (1, 1)), repeat=2):
        S[z + a, z + b] += (smoothness * w[1:-1]) ** 2 * da * db
    return S


def _solve_with_gauge(S: Float, r: Float) -> Float:
    """Return g of S g = r with g(n // 2) = 0: exactly, as a constant added to both g and lE costs nothing."""
    n = len(r)
    reached = (np.diag(S) > 0) | (np.arange(n) == n // 2)
    pinned = np.flatnonzero(~reached | (np.arange(n) == n // 2))
    S, r = S.copy(), r.copy()  # an equation g(z) = 0 for each pinned level
    S[pinned], S[:, pinned], r[pinned] = 0, 0, 0
    S[pinned, pinned] = 1
    try:
        g = np.linalg.solve(S, r)
    except np.linalg.LinAlgError as error:
        raise ValueError("expected more levels, frames or smoothness: the samples leave g open") from error
    return np.interp(np.arange(n), np.flatnonzero(reached), g[reached])


def recover(
    images: ArrayLike,
    times: ArrayLike,
    *,
    smoothness: float = 30.0,
    samples: int = 1000,
    w: ArrayLike | None = None,
    choose: Callable[..., NDArray[np.intp]] = by_rank,
    valid: ArrayLike | None = None,
    monotone: bool = True,
) -> Float:
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
        Weights; the geometric mean of hat and Gaussian, which on the worst of 201 measured curves errs less
        than either (on half of them the hat errs least). It is cut above 0.98 of the top level, where noise
        hides clipped pixels, and below 0.02, where noise is as large as the level.
    choose : function
        `sampling.by_rank` (default), `sampling.by_grid`, or your own with the same signature.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.
    monotone : bool
        Lift g where it falls, which happens at levels that no sample reached.

    Returns
    -------
    (256,) or (256, 3) float64
        g, the ln exposure of each level; g[128] = 0 in every channel, so mid gray is taken for neutral.

    Raises
    ------
    ValueError
        For fewer than two photographs or two times, and photographs that hold no level seen in two exposures.

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
    times = as_times(times, len(stack), distinct=2)
    if w is None:
        w = weights.cut(np.sqrt(weights.hat() * weights.gaussian()), below=0.02)
    w = as_table(w, 256)
    Z = choose(stack, samples, valid=valid)
    Z = Z.reshape(*Z.shape[:2], -1)
    g = np.stack([gsolve(Z[..., c], np.log(times), smoothness, w).g for c in range(Z.shape[-1])], axis=-1)
    g = straight_toe(g, w)
    if monotone:
        g = make_monotone(g)
    return g.reshape(256, *stack.shape[3:])


def straight_toe(g: Float, w: Float) -> Float:
    """Return g with f^-1 in proportion to z + 1/2 below the first level of weight: nothing else says."""
    first = int(np.argmax(w > 0))
    g = g.copy()
    g[:first] = g[first] + np.log((np.arange(first) + 0.5) / (first + 0.5))[:, None]
    return g


def _checked(
    Z: ArrayLike, B: ArrayLike, smoothness: float, w: ArrayLike
) -> tuple[NDArray[np.intp], Float, Float]:
    """Return Z, B and w as arrays that fit together, or raise a ValueError."""
    Z, B, w = np.asarray(Z), np.asarray(B, dtype=np.float64), np.asarray(w, dtype=np.float64)
    if not 0 <= smoothness < np.inf:
        raise ValueError(f"expected a smoothness that is finite and not negative, got {smoothness}")
    if Z.ndim != 2 or Z.dtype.kind not in "iu" or Z.size == 0:
        raise ValueError(f"expected integer pixel levels Z (N, P), got {describe(Z)}")
    if w.ndim != 1 or not np.all((w >= 0) & (w < np.inf)):
        raise ValueError(f"expected weights w (n,), finite and not negative, got {describe(w)}")
    if Z.min() < 0 or Z.max() >= len(w):
        raise ValueError(f"expected pixel levels 0 to {len(w) - 1}, as many as weights, got {describe(Z)}")
    if B.shape != Z.shape[1:] or not np.all(np.isfinite(B)):
        raise ValueError(f"expected finite ln times B ({Z.shape[1]},), got {describe(B)}")
    return Z.astype(np.intp, copy=False), B, w


def _require_two_exposures(W: Float, B: Float) -> None:
    """Raise a ValueError where no sample has weight in two exposures."""
    low = np.where(W > 0, B, np.inf).min(axis=1)
    high = np.where(W > 0, B, -np.inf).max(axis=1)
    if not np.any(high > low):
        raise ValueError("expected samples seen well in two exposures, which tie levels together; got none")
