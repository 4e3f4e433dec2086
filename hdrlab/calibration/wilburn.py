"""Joining blends by a polynomial (Wilburn, Xu and Matsushita, CVPR 2008, sec. 2.2).

I_ij  relative irradiance   of sample i in blend j; s_j I_ij + r_j is its exposure in the curve's own unit
m_ij  brightness            0 at the lowest one measured, 1 at the highest
g     inverse response      g(m) = sum_k a_k m^k, a_0 = 0, sum_k a_k = 1: g(0) = 0, g(1) = 1
E     error                 sum_ij (s_j I_ij + r_j - g(m_ij))^2  [eq. 5, where the print has s_i for s_j and
                            lets i run to l_j, one too far]

The paper uses powers of the brightness itself. Its constraint then fixes g at brightness 0 and 1,
outside of the measured range; in between, the scales can shrink and g can become flat with hardly
any error. Here the two points are at the ends of the measured range, where the paper compares its
curves.

For a given g, the best s_j and r_j are a straight line through (I_ij, g(m_ij)), so the simplex
searches only the d - 1 free coefficients. The residuals of the lines are linear in a, so E = a^T Q
a, with a matrix Q (d + 1, d + 1) that is computed once for any number of samples. `joining` solves
a better-posed problem.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.polynomial.polynomial import polyder, polyval
from scipy.optimize import minimize

from hdrlab.calibration.blends import (
    GRID,
    Blend,
    InverseResponse,
    build_response,
    rescale,
    select_blends,
)
from hdrlab.core.arrays import F64, ArrayLike
from hdrlab.core.steps import last
from hdrlab.errors import InputError

SIMPLEX = {"xatol": 1e-6, "fatol": 1e-12, "maxfev": 4000, "adaptive": True}


class State(NamedTuple):
    """After a run of the simplex: a (d + 1,), the error E, and how often E was computed."""

    a: F64
    E: float
    calls: int


def complete(free: F64) -> F64:
    """Return a = (0, a_1 ... a_d) of a_2 ... a_d, with sum_k a_k = 1."""
    return np.concatenate([[0.0, 1 - free.sum()], free])


def evaluate(m: F64, a: F64) -> F64:
    """Return g(m) = sum_k a_k m^k [Wilburn08 sec. 2.2]."""
    return np.asarray(polyval(m, a), np.float64)


def quadratic_form(blends: Sequence[Blend], degree: int) -> F64:
    """Return Q of E = a^T Q a: sum_j V^T (1 - P) V, V_ik = m_ij^k, P the projection on lines in I."""
    Q = np.zeros((degree + 1, degree + 1))
    for I, M in blends:  # noqa: E741, the paper's letter
        V = M[:, None] ** np.arange(degree + 1)
        lines = np.linalg.qr(np.column_stack([I, np.ones(len(V))]))[0]
        residual = V - lines @ (lines.T @ V)
        Q += residual.T @ residual
    return Q


def error(a: ArrayLike, Q: F64) -> float:
    """Return E = a^T Q a: eq. 5 at the best s and r."""
    a = np.asarray(a, np.float64)
    return float(a @ Q @ a)


def join_steps(blends: Sequence[Blend], *, degree: int = 6, runs: int = 12) -> Iterator[State]:
    """Yield the State after each run of the Nelder-Mead simplex, the next from where the last one stopped.

    A g that falls anywhere has an infinite error, so the simplex stays where g' >= 0. Against that
    wall it may collapse before the minimum; a new one goes on.
    """
    if degree < 2 or runs < 1:
        raise InputError(
            f"expected a degree of 2 or more and at least 1 run, got {degree} and {runs}"
        )
    Q = quadratic_form(rescale(select_blends(blends)), degree)

    def monotone_error(free: F64) -> float:
        a = complete(free)
        return error(a, Q) if evaluate(GRID, np.asarray(polyder(a))).min() >= 0 else np.inf

    free = np.zeros(degree - 1)
    for _ in range(runs):
        start = np.vstack([free, free + np.diag(np.where(free == 0, 0.05, 0.1 * free))])
        options = SIMPLEX | {"initial_simplex": start}
        found = minimize(monotone_error, free, method="Nelder-Mead", options=options)
        free = found.x
        yield State(complete(free), float(found.fun), int(found.nfev))


def join(
    blends: Sequence[Blend], *, degree: int = 6, runs: int = 12, ends: float = 0.005
) -> InverseResponse:
    """Return the inverse response that joins the blends, a monotone polynomial, found by simplex.

    Parameters
    ----------
    blends : sequence of Blend
        Samples of a few mixtures, within the measured range: see `blends.make_blend`.
    degree : int
        d of the polynomial.
    runs : int
        How often the simplex starts from scratch.
    ends : float
        The part of the samples at either end that lies outside of the curve returned: see
        `blends.build_response`.

    Returns
    -------
    InverseResponse
        X over M, from 0 to 1 over the measured range, with scales s and offsets r in that unit.

    Raises
    ------
    ValueError
        For blends without three samples of different brightness.

    References
    ----------
    Wilburn, Xu and Matsushita, Radiometric calibration using temporal irradiance mixtures, CVPR
    2008, eq. 5.

    Examples
    --------
    >>> alpha = np.linspace(0, 1, 16)
    >>> bright, dim = Blend(alpha, alpha**0.5), Blend(alpha, (0.2 * alpha) ** 0.5)  # a camera with f = root
    >>> joined = join([bright, dim])
    >>> round(float(np.interp(0.5, joined.M, joined.X)), 2), round(float(joined.s[1] / joined.s[0]), 2)
    (0.25, 0.2)
    """
    a = last(join_steps(blends, degree=degree, runs=runs)).a
    usable = select_blends(blends)
    s, r = np.transpose([np.polyfit(blend.I, evaluate(blend.M, a), 1) for blend in rescale(usable)])
    return build_response(usable, evaluate(GRID, a), s, r, ends=ends)
