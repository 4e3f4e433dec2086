"""Calibration from temporal mixtures of two lights (Wilburn, Xu and Matsushita, CVPR 2008, sec. 2.2).

I_ij  relative irradiance   of sample i in blend j; s_j I_ij + r_j is its exposure in the curve's own unit
M_ij  brightness            0 to 1
m     place in the range    0 at the lowest brightness measured, 1 at the highest
g     inverse response      g(m) = sum_k a_k m^k, a_0 = 0, sum_k a_k = 1: g(0) = 0, g(1) = 1
E     error                 sum_ij (s_j I_ij + r_j - g(m_ij))^2  [eq. 5, where the print has s_i for s_j and
                            lets i run to l_j, one too far]

The paper takes powers of M itself. Its constraint then pins g at M = 0 and M = 1, outside of what was
measured, and in between the scales can shrink and g lie down flat, with hardly an error. Here the pins stand
at the ends of the measured range, where the paper compares its curves.

For a given g the best s_j and r_j are a straight line through (I_ij, g(m_ij)), so the simplex need not look
for them: it walks in the d - 1 free coefficients alone. What the lines leave is linear in a, hence E = a^T Q
a, with a table Q (d + 1, d + 1) that is made once, however many samples there are. `joining` has a better
posed way; `schedules` makes the display's pictures, `motion` reads the ramps of motion blur.
"""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize

from hdrlab.calibration.blends import POINTS, Blend, Joined, as_blends, domain, unit, within
from hdrlab.core.steps import last

Float = NDArray[np.float64]
GRID = np.linspace(0, 1, 257)  # where the slope is looked at


class State(NamedTuple):
    """After a run of the simplex: a (d + 1,), the error E, and how often E was computed."""

    a: Float
    E: float
    calls: int


def coefficients(free: ArrayLike) -> Float:
    """Return a = (0, a_1 ... a_d) of a_2 ... a_d, with sum_k a_k = 1."""
    free = np.asarray(free, np.float64)
    return np.concatenate([[0.0, 1 - free.sum()], free])


def value(m: ArrayLike, a: ArrayLike) -> Float:
    """Return g(m) = sum_k a_k m^k [Wilburn08 sec. 2.2]."""
    return np.asarray(np.polyval(np.asarray(a, np.float64)[::-1], np.asarray(m)), np.float64)


def slope(m: ArrayLike, a: ArrayLike) -> Float:
    """Return g'(m)."""
    return value(m, np.polynomial.polynomial.polyder(np.asarray(a, np.float64)))


def line(irradiance: Float, X: Float) -> tuple[float, float]:
    """Return s and r of the straight line s I + r that fits X best: least squares."""
    away = irradiance - irradiance.mean()
    s = float(away @ X / (away @ away))
    return s, float(X.mean() - s * irradiance.mean())


def quadratic(blends: Sequence[Blend], degree: int) -> Float:
    """Return Q of E = a^T Q a: sum_j V^T (1 - P) V, V_ik = m_ij^k, P the projection on lines in I."""
    Q = np.zeros((degree + 1, degree + 1))
    for one in blends:
        V = one.M[:, None] ** np.arange(degree + 1)
        lines = np.linalg.qr(np.column_stack([one.I, np.ones(len(V))]))[0]
        left = V - lines @ (lines.T @ V)
        Q += left.T @ left
    return Q


def error(a: ArrayLike, Q: Float) -> float:
    """Return E = a^T Q a: eq. 5 at the best s and r."""
    a = np.asarray(a, np.float64)
    return float(a @ Q @ a)


def join_steps(blends: Sequence[Blend], *, degree: int = 6, runs: int = 12) -> Iterator[State]:
    """Yield the State after each run of the Nelder-Mead simplex, the next from where the last one stopped.

    A g that falls anywhere has an infinite error, so the simplex stays where g' >= 0. Against that wall it
    may fold up before the minimum; a fresh one goes on.
    """
    blends = as_blends(blends)
    if degree < 2 or runs < 1:
        raise ValueError(f"expected a degree of 2 or more and at least 1 run, got {degree} and {runs}")
    low, high = domain(blends)
    Q = quadratic([Blend(one.I, (one.M - low) / (high - low)) for one in blends], degree)

    def walled(free: Float) -> float:
        a = coefficients(free)
        return error(a, Q) if slope(GRID, a).min() >= 0 else np.inf

    free = np.zeros(degree - 1)
    for _ in range(runs):
        start = np.vstack([free, free + np.diag(np.where(free == 0, 0.05, 0.1 * free))])
        found = minimize(
            walled,
            free,
            method="Nelder-Mead",
            options={
                "initial_simplex": start,
                "xatol": 1e-6,
                "fatol": 1e-12,
                "maxfev": 4000,
                "adaptive": True,
            },
        )
        free = found.x
        yield State(coefficients(free), float(found.fun), int(found.nfev))


def join(blends: Sequence[Blend], *, ends: float = 0.005, **knobs: Any) -> Joined:
    """Return the inverse response that joins the blends, a monotone polynomial, found by simplex.

    Parameters
    ----------
    blends : sequence of Blend
        Samples of a few mixtures, within the measured range: see `blends.blend`.
    ends : float
        The part of the samples at either end that lies outside of the curve returned: see `blends.within`.
    degree : int
        d of the polynomial, 6.
    runs : int
        How often the simplex starts afresh, 12.

    Returns
    -------
    Joined
        X over M, from 0 to 1 over the measured range, with scales s and offsets r in that unit.

    Raises
    ------
    ValueError
        For blends without three samples of different brightness.

    References
    ----------
    Wilburn, Xu and Matsushita, Radiometric calibration using temporal irradiance mixtures, CVPR 2008, eq. 5.

    Examples
    --------
    >>> alpha = np.linspace(0, 1, 16)
    >>> bright, dim = Blend(alpha, alpha**0.5), Blend(alpha, (0.2 * alpha) ** 0.5)  # a camera with f = root
    >>> joined = join([bright, dim])
    >>> round(float(np.interp(0.5, joined.M, joined.X)), 2), round(float(joined.s[1] / joined.s[0]), 2)
    (0.25, 0.2)
    """
    a = last(join_steps(blends, **knobs)).a
    told = as_blends(blends)
    low, high = domain(told)
    s, r = np.array([line(one.I, value((one.M - low) / (high - low), a)) for one in told]).T
    m = np.linspace(0, 1, POINTS)
    return within(unit(low + m * (high - low), value(m, a), s, r), told, ends)


def display(P: ArrayLike, joined: Joined) -> tuple[Float, Float]:
    """Return the display's own response: its pixel values (n + 1,), and their light over that of the largest.

    Blend j shows the pixel value P_j for the share alpha and black for the rest, so s_j is what P_j gives
    more than black: several blends calibrate the screen as well as the camera [Wilburn08 sec. 6]. The first
    of the n + 1 is black itself, 0.

    Raises
    ------
    ValueError
        Where there is not one pixel value per blend.
    """
    P = np.asarray(P, np.float64)
    if P.shape != joined.s.shape:
        raise ValueError(f"expected {len(joined.s)} pixel values, one per blend, got shape {P.shape}")
    order = np.argsort(P)
    return np.r_[0.0, P[order]], np.r_[0.0, joined.s[order]] / joined.s[order[-1]]
