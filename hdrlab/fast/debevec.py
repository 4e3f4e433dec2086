"""Debevec and Malik's response from n unknowns instead of n + N: see `response.debevec`.

For a given g each sample's best lE_i is a weighted mean, sum_j w^2 (g(Z_ij) - B_j) / sum_j w^2. Put
into the normal equations it leaves a system S g = r in g alone (a Schur complement). A sample has P
levels, and so it adds to P x P entries of S.
"""

from itertools import product

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, Indices, describe
from hdrlab.core.sampling import require_two_exposures
from hdrlab.errors import InputError
from hdrlab.fast import with_parts
from hdrlab.response import debevec


def gsolve(Z: ArrayLike, B: ArrayLike, smoothness: float, w: ArrayLike) -> debevec.Solution:
    """Return the same least-squares solution as the lesson; g[n // 2] = 0 exactly.

    Raises
    ------
    InputError
        If the arrays do not fit together, or no sample is well exposed in two different exposures.
    """
    Z, B, w = _validate(Z, B, smoothness, w)
    n = len(w)
    W = w[Z] ** 2
    require_two_exposures(Z, B, w)
    # D[i] is the coefficient of lE_i in its own normal equation
    D = W.sum(axis=1)
    has_weight = D > 0
    D[~has_weight] = 1
    means = (W @ B) / D
    # eliminating lE_i couples each two levels of sample i
    level_pairs = n * Z[:, :, None] + Z[:, None]
    pair_weights = W[:, :, None] * (W / D[:, None])[:, None]
    coupling = np.bincount(level_pairs.ravel(), pair_weights.ravel(), n * n).reshape(n, n)
    diagonal = np.diag(np.bincount(Z.ravel(), W.ravel(), n))
    S = diagonal - coupling + _stiffness(w, smoothness)
    r = np.zeros(n)
    np.add.at(r, Z, W * (B - means[:, None]))
    g = _solve_with_gauge(S, r)
    lE = np.where(has_weight, (W * g[Z]).sum(axis=1) / D - means, 0.0)
    return debevec.Solution(g, lE)


def _stiffness(w: F64, smoothness: float) -> F64:
    """Return D^T D, where D = `core.weights.second_differences`, from the three diagonals of D."""
    S = np.zeros((len(w), len(w)))
    z = np.arange(1, len(w) - 1)
    for (a, da), (b, db) in product(((-1, 1), (0, -2), (1, 1)), repeat=2):
        S[z + a, z + b] += (smoothness * w[1:-1]) ** 2 * da * db
    return S


def _solve_with_gauge(S: F64, r: F64) -> F64:
    """Return g of S g = r with g(n // 2) = 0.

    The gauge holds exactly, because a constant added to both g and lE costs nothing. Levels that
    neither a sample nor smoothness reaches are interpolated.
    """
    n = len(r)
    is_gauge = np.arange(n) == n // 2
    reached = (np.diag(S) > 0) | is_gauge
    pinned = np.flatnonzero(~reached | is_gauge)
    # an equation g(z) = 0 for each pinned level
    S = S.copy()
    r = r.copy()
    S[pinned] = 0
    S[:, pinned] = 0
    r[pinned] = 0
    S[pinned, pinned] = 1
    try:
        g = np.linalg.solve(S, r)
    except np.linalg.LinAlgError as error:
        raise InputError(
            "the samples do not determine g; use more pixels, photos or smoothness"
        ) from error
    return np.interp(np.arange(n), np.flatnonzero(reached), g[reached])


recover = with_parts(__name__, debevec.recover, gsolve=gsolve)


def _validate(
    Z: ArrayLike, B: ArrayLike, smoothness: float, w: ArrayLike
) -> tuple[Indices, F64, F64]:
    """Return Z, B and w as arrays that fit together, or raise a ValueError."""
    Z = np.asarray(Z)
    B = np.asarray(B, dtype=np.float64)
    w = np.asarray(w, dtype=np.float64)
    if not 0 <= smoothness < np.inf:
        raise InputError(f"expected a smoothness that is finite and not negative, got {smoothness}")
    if Z.ndim != 2 or Z.dtype.kind not in "iu" or Z.size == 0:
        raise InputError(f"expected integer pixel levels Z (N, P), got {describe(Z)}")
    if w.ndim != 1 or not np.all((w >= 0) & (w < np.inf)):
        raise InputError(f"expected weights w (n,), finite and not negative, got {describe(w)}")
    if Z.min() < 0 or Z.max() >= len(w):
        raise InputError(
            f"expected pixel levels 0 to {len(w) - 1}, as many as weights, got {describe(Z)}"
        )
    if B.shape != Z.shape[1:] or not np.all(np.isfinite(B)):
        raise InputError(f"expected finite ln times B ({Z.shape[1]},), got {describe(B)}")
    return Z.astype(np.intp, copy=False), B, w
