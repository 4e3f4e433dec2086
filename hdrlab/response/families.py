"""A family of responses by formula, for a prior where no measured curves are at hand.

M  brightness   0 to 1
X  exposure     f^-1(M), X(0) = 0, X(1) = 1, rising
g  ln f^-1      (n,) over the pixel levels, g[n // 2] = 0

Five kinds, each on a grid of its parameters, and each as it is and behind an S-curve that a maker
of pictures
may add:

power       X = M^gamma                                     displays, and film as Mann and Picard fit it
toe         power with a straight start, tangent to it      sRGB, Rec. 709 and their like
film        X^gamma = a M / (1 + a - M)                     toe and shoulder over ln X, after Naka and Rushton
logarithm   X = (e^(k M) - 1) / (e^k - 1)                   cameras of wide range
cubic       X = (M + k M^3) / (1 + k)                       nearly linear sensors, of either bend
"""

from collections.abc import Iterator

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, describe
from hdrlab.errors import InputError

# Exposures of measured curves are at least this, because ln 0 is infinite.
_MIN_EXPOSURE = 1e-6


def power(M: F64, gamma: float) -> F64:
    """Return X = M^gamma.

    Examples
    --------
    >>> power(np.array([0.25, 1.0]), 2).tolist()
    [0.0625, 1.0]
    """
    return M**gamma


def toe(M: F64, gamma: float, start: float) -> F64:
    """Return ((M + a) / (1 + a))^gamma above M = `start`, and below it its tangent, which goes through 0.

    The tangent does if start gamma = start + a.
    """
    a = start * (gamma - 1)
    line = ((start + a) / (1 + a)) ** gamma * M / start
    return np.where(start < M, ((M + a) / (1 + a)) ** gamma, line)


def film(M: F64, a: float, gamma: float) -> F64:
    """Return X = (a M / (1 + a - M))^(1 / gamma)."""
    return (a * M / (1 + a - M)) ** (1 / gamma)


def logarithm(M: F64, k: float) -> F64:
    """Return X = (e^(k M) - 1) / (e^k - 1)."""
    return np.expm1(k * M) / np.expm1(k)


def cubic(M: F64, k: float) -> F64:
    """Return X = (M + k M^3) / (1 + k), rising for k >= -1/3."""
    return (M + k * M**3) / (1 + k)


def shoulder(M: F64, strength: float) -> F64:
    """Return M drawn towards the S-curve M^2 (3 - 2 M), or for a negative strength away from it."""
    return M + strength * (M**2 * (3 - 2 * M) - M)


def generate_curves(M: F64) -> Iterator[F64]:
    """Yield X of every curve of the five kinds."""
    yield from (power(M, gamma) for gamma in np.arange(0.4, 3.01, 0.1))
    yield from (
        toe(M, gamma, start) for gamma in (1.6, 2.0, 2.4, 2.8) for start in (0.02, 0.04, 0.08)
    )
    yield from (
        film(M, a, gamma) for a in (0.03, 0.1, 0.3, 1.0) for gamma in (0.7, 0.9, 1.1, 1.3, 1.5)
    )
    yield from (logarithm(M, k) for k in (0.5, 1, 2, 3, 4, 5, 6))
    yield from (cubic(M, k) for k in (-0.3, -0.15, 0, 0.3, 1, 3, 8))


def level_brightness(n: int) -> F64:
    """Return M (n,) in the middles of the levels' cells; level 0 has half a cell."""
    return np.r_[0.25, np.arange(1, n)] / (n - 1)


def tabulate(n: int = 256) -> F64:
    """Return X (C, n) of all curves."""
    M = level_brightness(n)
    curves: list[F64] = []
    for strength in (-0.4, 0.0, 0.4):
        curves += generate_curves(shoulder(M, strength))
    return np.stack(curves)


def to_log(X: ArrayLike) -> F64:
    """Return g = ln X - ln X[n // 2] of curves (C, n)."""
    g = np.log(np.asarray(X, np.float64))
    return g - g[:, g.shape[1] // 2, None]


def invert_curves(exposure: ArrayLike, brightness: ArrayLike, *, n: int = 256) -> F64:
    """Return g (C, n) of measured curves: exposure (C, m), 0 to 1, and the brightness it gives, both rising.

    A g has one value where the curve is flat: the middle of the exposures that give this level.

    Raises
    ------
    ValueError
        For curves that do not rise from 0 to 1.
    """
    X = np.atleast_2d(np.asarray(exposure, np.float64))
    M = np.atleast_2d(np.asarray(brightness, np.float64))
    if X.shape != M.shape or not np.all(np.isfinite([X, M])):
        raise InputError(
            f"expected exposure and brightness (C, m), finite, got {describe(X)}, {describe(M)}"
        )
    if np.any(np.diff([X, M]) < 0) or not np.all(M[:, 0] < M[:, -1]):
        raise InputError("expected curves that rise, got one that falls or is flat")
    levels = level_brightness(n)
    inverse = [_invert(levels, x, m) for x, m in zip(X, M, strict=True)]
    return to_log(np.maximum(inverse, _MIN_EXPOSURE))


def _invert(levels: F64, X: F64, M: F64) -> F64:
    """Return X at these brightnesses; of a flat stretch, the mean of its ends."""
    values, start, counts = np.unique(M, return_index=True, return_counts=True)
    return np.interp(levels, values, (X[start] + X[start + counts - 1]) / 2)
