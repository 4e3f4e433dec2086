"""Responses as polynomials, in a basis that stays well conditioned (Mitsunaga and Nayar, CVPR 1999, sec. 3).

M    brightness     0 ... 1: pixel level over the highest one
X    exposure       0 ... 1, where 1 just reaches the highest level
f    M -> X         the inverse response: f(0) = 0, f(1) = 1, rising
N    order          of the polynomial
c    coefficients   (N - 1,)
b_n  basis          M (1 - M) T_n(2 M - 1), n = 0 ... N - 2, with T_n the Chebyshev polynomials

f(M) = M + sum_n c_n b_n(M). Every polynomial of order N through (0, 0) and (1, 1) can be written so, and no
other can: the scale of eq. 8 needs no equation of its own, and c = 0 is the linear camera. The powers M^n of
eq. 3 are so alike that at N = 10 their normal equations lose all digits; these b_n swing, and keep most.
"""

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebval, chebvander
from numpy.typing import ArrayLike, NDArray

Float = NDArray[np.float64]
GRID = np.linspace(0, 1, 2049)


def basis(M: ArrayLike, order: int) -> Float:
    """Return b_n(M), (..., N - 1)."""
    M = np.asarray(M, dtype=np.float64)
    return (M * (1 - M))[..., None] * _chebyshev(M, order)


def value(M: ArrayLike, c: ArrayLike) -> Float:
    """Return f(M) = M + sum_n c_n b_n(M) [Mitsunaga99 eq. 3]; of c (C, N - 1), for the channels of M.

    Examples
    --------
    >>> value([0, 0.5, 1], []).tolist()  # with no terms a straight line
    [0.0, 0.5, 1.0]
    """
    M = np.asarray(M, dtype=np.float64)
    return np.asarray(M + M * (1 - M) * chebval(2 * M - 1, _first(c, M), tensor=False))


def slope(M: ArrayLike, c: ArrayLike) -> Float:
    """Return f'(M), by the product rule; of c (C, N - 1), for the channels of M (C, ...)."""
    M = np.asarray(M, dtype=np.float64)
    c = _first(c, M)
    T, dT = (chebval(2 * M - 1, each, tensor=False) for each in (c, 2 * chebder(c)))
    return np.asarray(1 + (1 - 2 * M) * T + M * (1 - M) * dT)


def misfit(a: Float, b: Float, R: Float | float, c: Float) -> Float:
    """Return (f(a) - R f(b)) / sqrt(f'(a)^2 + (R f'(b))^2): what eq. 5 misses, as noise of a and b."""
    steepness = np.hypot(slope(a, c), R * slope(b, c))
    return np.asarray((value(a, c) - R * value(b, c)) / np.maximum(steepness, 1e-9))


def _first(c: ArrayLike, M: Float) -> Float:
    """Return c with its terms first, (n, C, 1, ...) for M (C, ...), and a term of 0 where there is none."""
    c = np.asarray(c, dtype=np.float64)
    c = np.moveaxis(c, -1, 0) if c.shape[-1] else np.zeros((1, *c.shape[:-1]))
    return c.reshape(*c.shape, *(1,) * (M.ndim + 1 - c.ndim))


def _chebyshev(M: Float, order: int) -> Float:
    return np.asarray(chebvander(2 * M - 1, max(order - 2, 0))[..., : order - 1], dtype=np.float64)


def brightness(X: ArrayLike, c: ArrayLike) -> Float:
    """Return M = f^-1(X) of a rising f, read off a fine grid; 1 for exposures beyond 1, which clip."""
    return np.interp(np.asarray(X), value(GRID, c), GRID)


def rising(c: ArrayLike, *, least: float = 0.01) -> Float:
    """Return c drawn towards 0, the straight line, just so far that f' >= least everywhere.

    Drawn by s, f' becomes 1 + s (f' - 1).
    """
    c = np.asarray(c, dtype=np.float64)
    lowest = slope(GRID, c).min()
    return c if lowest >= least else c * (1 - least) / (1 - lowest)


def curve(c: ArrayLike, n: int = 256, *, least: float = 1e-4) -> Float:
    """Return g = ln f (n,), g[n // 2] = 0, where f climbs by at least `least` / (n - 1) from level to level.

    A polynomial may dip where no pixel held it; a g that falls has no inverse, and f / f' would change its
    sign. The clamp acts on the increments, so the curve keeps its shape wherever it rises. Level 0 holds what
    is darker than half a level; it gets the middle of that.
    """
    M = np.arange(n) / (n - 1)
    f = np.concatenate([[0], np.cumsum(np.maximum(np.diff(value(M, c)), least / (n - 1)))])
    f[0] = f[1] / 4
    return np.log(f / f[n // 2])


def random(rng: np.random.Generator, *, order: int = 5, least: float = 0.02) -> Float:
    """Return c of a rising curve drawn at random.

    Powers M ... M^N get coefficients uniform in -1 ... 1, scaled to f(1) = 1; drawn again until f' >= least.
    """
    n = np.arange(1, order + 1)
    while True:
        a = rng.uniform(-1, 1, order)
        if np.min(GRID[:, None] ** (n - 1) @ (n * a / a.sum())) >= least:
            break
    at = (np.arange(order - 1) + 0.5) / (order - 1)  # N - 1 points fix the N - 1 numbers c
    return np.asarray(np.linalg.solve(basis(at, order), at[:, None] ** n @ (a / a.sum()) - at))
