"""Responses as polynomials: what is asked of f^-1, M -> exposure, beside its value (see `mitsunaga`).

M     brightness     0 ... 1: pixel level over the highest one
X     exposure       0 ... 1, where 1 just reaches the highest level
c     coefficients   (N - 1,) of f^-1(M) = M + M (1 - M) sum_n c_n T_n(2 M - 1)
"""

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebval

from hdrlab.core.arrays import F64, ArrayLike
from hdrlab.response.mitsunaga import value

GRID = np.linspace(0, 1, 2049)


def slope(M: ArrayLike, c: ArrayLike) -> F64:
    """Return the derivative of f^-1 at M, by the product rule.

    Examples
    --------
    >>> slope([0, 0.5, 1], []).tolist()  # of a straight line
    [1.0, 1.0, 1.0]
    """
    M = np.asarray(M, np.float64)
    c = np.append(c, 0)
    T = chebval(2 * M - 1, c)
    dT = chebval(2 * M - 1, 2 * chebder(c))
    return np.asarray(1 + (1 - 2 * M) * T + M * (1 - M) * dT)


def misfit(M: F64, R: F64 | float, c: F64) -> F64:
    """Return what eq. 5 misses for samples M (N, P), as noise of brightness, (N, P - 1).

    (f^-1(M_q) - R f^-1(M_q+1)) over the square root of the sum of their squared derivatives by M.
    """
    X = value(M, c)
    dX = slope(M, c)
    return (X[:, :-1] - R * X[:, 1:]) / np.maximum(np.hypot(dX[:, :-1], R * dX[:, 1:]), 1e-9)


def brightness(X: ArrayLike, c: ArrayLike) -> F64:
    """Return M = f(X) of a rising polynomial, read off a fine grid; 1 for exposures beyond 1, which clip."""
    return np.interp(np.asarray(X), value(GRID, c), GRID)


def limit_slope(c: ArrayLike, *, least: float = 0.01) -> F64:
    """Return c drawn towards 0, the straight line, just so far that the slope is `least` or more everywhere.

    Drawn by s, the slope becomes 1 + s (slope - 1).
    """
    c = np.asarray(c, np.float64)
    lowest = slope(GRID, c).min()
    return c if lowest >= least else c * (1 - least) / (1 - lowest)
