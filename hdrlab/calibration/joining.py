"""Joining blends by a monotone spline (Wilburn et al., CVPR 2008, eq. 5, better posed; Ramsay, 1988).

I_ij  relative irradiance   of sample i in blend j
m_ij  brightness            0 to 1, from the lowest measured to the highest
s, r  scales and offsets    (n,); s of the widest blend is 1, which fixes the unit
B_k   B-splines             K cubic ones, knots evenly over 0 to 1; B_k lies h_k to the right of B_k-1
S_k   I-splines             B_k + B_k+1 + ... + B_K-1: rises from 0 to 1 [Ramsay88]
c     increments            (K,) >= 0: g = sum_k c_k S_k never falls, and c_k / h_k is a slope
p     predicted brightness  g^-1(s_j I_ij + r_j), g of the iteration before
v     slope                 g' of the iteration before, v_k at B-spline k
lambda  `smoothness`

A polynomial of degree 6 is too stiff where a response bends and oscillates where it is straight,
and a simplex may stop too early. Here every iteration is a least-squares problem in c, s and r with
c >= 0,

    sum_ij ((g(p) - s_j I_ij - r_j) / v(p) + m_ij - p)^2 + lambda sum_k ((c / h)''_k / v_k)^2,

the Gauss-Newton form of sum_ij (m_ij - f(s_j I_ij + r_j))^2. The noise is in m. If m were the
argument of g, as in eq. 5, noise would be on both sides of the fit and flatten the curve. So g is
evaluated at the predicted brightness p. The third differences of the spline's coefficients, which
are second differences of its slopes, are divided by the slope: a toe a hundred times flatter than
the shoulder is smoothed a hundred times less.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from scipy.interpolate import BSpline
from scipy.optimize import nnls

from hdrlab.calibration.blends import (
    GRID,
    Blend,
    InverseResponse,
    build_response,
    rescale,
    select_blends,
)
from hdrlab.core.arrays import F64
from hdrlab.core.steps import last
from hdrlab.errors import InputError

# relative to the mean slope; a flatter part can hardly be distinguished from a step
MIN_RELATIVE_SLOPE = 1e-3


class State(NamedTuple):
    """The curve g and its slope v (1024,), scales s and offsets r (n,), and the cost after an iteration."""

    g: F64
    v: F64
    s: F64
    r: F64
    cost: float


def knots(count: int) -> F64:
    """Return the knots of `count` cubic B-splines on 0 to 1."""
    return np.r_[[0.0] * 3, np.linspace(0, 1, count - 2), [1.0] * 3]


def i_splines(m: F64, count: int) -> F64:
    """Return S_k(m), (l, K): each rises from 0 to 1.

    Examples
    --------
    >>> i_splines(np.array([0.0, 1.0]), 5).round(3).tolist()
    [[1.0, 0.0, 0.0, 0.0, 0.0], [1.0, 1.0, 1.0, 1.0, 1.0]]
    """
    B = BSpline.design_matrix(np.clip(m, 0, 1), knots(count), 3).toarray()
    return B[:, ::-1].cumsum(axis=1)[:, ::-1]


def slope_curvature(v: F64, count: int) -> F64:
    """Return the rows (K - 3, K) of (c / h)''_k / v_k; c_0 is g(0), no slope.

    A B-spline's place is the mean of its three inner knots (Greville's abscissa).
    """
    t = knots(count)
    places = (t[1:-3] + t[2:-2] + t[3:-1]) / 3
    h = np.diff(places)
    middle = (places[1:] + places[:-1]) / 2
    rows = np.diff(np.diag(1 / h), 2, axis=0) / np.interp(middle[1:-1], GRID, v)[:, None]
    return np.pad(rows, ((0, 0), (1, 0)))


def build_equations(
    blends: Sequence[Blend], p: F64, v: F64, count: int, offset: bool
) -> list[tuple[F64, F64, F64]]:
    """Return A, F, b of each blend: A c - F (s, r) = b. The scale of the widest blend is 1, no unknown.

    p contains the predicted brightnesses of all blends, one blend after the other.
    """
    widest = int(np.argmax([np.ptp(blend.M) for blend in blends]))
    weight = 1 / np.interp(p, GRID, v)
    A = i_splines(p, count) * weight[:, None]
    systems = []
    start = 0
    for j, (I, M) in enumerate(blends):  # noqa: E741, the paper's letter
        own = slice(start, start + len(M))
        F = np.column_stack([I, np.ones(len(I))])[:, int(j == widest) : 2 if offset else 1]
        b = p[own] - M + (j == widest) * I * weight[own]
        systems.append((A[own], F * weight[own, None], b))
        start = own.stop
    return systems


def eliminate(A: F64, F: F64, b: F64) -> F64:
    """Return [A b] with the blend's own unknowns eliminated: (1 - Q Q^T) [A b], F = Q R."""
    Q = np.linalg.qr(F)[0]
    rows = np.column_stack([A, b])
    return rows - Q @ (Q.T @ rows)


def solve_increments(
    systems: Sequence[tuple[F64, F64, F64]], penalty: F64, offset: bool
) -> tuple[F64, float]:
    """Return c >= 0 and the cost of all blends' equations together; with offsets free, c_0 is 0."""
    rows = [eliminate(*system) for system in systems]
    rows.append(np.pad(penalty, ((0, 0), (0, 1))))
    # K + 1 rows with the same least-squares solution
    R = np.asarray(np.linalg.qr(np.vstack(rows), mode="r"))
    if offset:
        R[:, 0] = 0
    c, norm = nnls(R[:, :-1], R[:, -1])
    return c, float(norm**2)


def update(
    blends: Sequence[Blend], p: F64, v: F64, *, count: int, smoothness: float, offset: bool
) -> State:
    """Return the State after an iteration, given the predicted brightnesses p and the slope v."""
    systems = build_equations(blends, p, v, count, offset)
    c, cost = solve_increments(systems, np.sqrt(smoothness) * slope_curvature(v, count), offset)
    g = i_splines(GRID, count) @ c
    if not g[-1] > g[0]:
        raise InputError("the brightness does not rise with the irradiance; check the blends")
    s = np.ones(len(systems))
    r = np.zeros(len(systems))
    for j, (A, F, b) in enumerate(systems):
        unknowns = np.linalg.lstsq(F, A @ c - b, rcond=None)[0]
        has_scale = len(unknowns) == 1 + offset
        if has_scale:
            s[j] = unknowns[0]
        if offset:
            r[j] = unknowns[-1]
    v = np.maximum(np.gradient(g, GRID), MIN_RELATIVE_SLOPE * (g[-1] - g[0]))
    return State(g, v, s, r, cost)


def predict_brightness(blends: Sequence[Blend], state: State) -> F64:
    """Return p = g^-1(s_j I_ij + r_j), one blend after the other."""
    rising = state.g + 1e-12 * state.g[-1] * GRID  # so that the inverse is unique where g is flat
    X = [s * blend.I + r for blend, s, r in zip(blends, state.s, state.r, strict=True)]
    return np.interp(np.concatenate(X), rising, GRID)


def join_steps(
    blends: Sequence[Blend],
    *,
    count: int = 24,
    smoothness: float = 1e-5,
    offset: bool = True,
    max_iterations: int = 30,
    tolerance: float = 2e-5,
) -> Iterator[State]:
    """Yield the State after each iteration, until the curve moves by less than `tolerance` of its range."""
    blends = rescale(select_blends(blends))
    if count < 6 or not smoothness >= 0 or max_iterations < 1:
        raise InputError(f"expected {count=} >= 6, {smoothness=} >= 0 and {max_iterations=} >= 1")
    p = np.concatenate([blend.M for blend in blends])
    v = np.ones_like(GRID)
    previous = GRID
    for _ in range(max_iterations):
        state = update(blends, p, v, count=count, smoothness=smoothness, offset=offset)
        yield state
        curve = state.g / state.g[-1]
        if np.abs(curve - previous).max() < tolerance:
            return
        p = predict_brightness(blends, state)
        v = state.v
        previous = curve


def join(
    blends: Sequence[Blend],
    *,
    count: int = 24,
    smoothness: float = 1e-5,
    offset: bool = True,
    ends: float = 0.005,
) -> InverseResponse:
    """Return the inverse response that joins the blends, a monotone spline.

    Parameters
    ----------
    blends : sequence of Blend
        Samples of a few mixtures, within the measured range: see `blends.make_blend`.
    count : int
        K, the number of B-splines.
    smoothness : float
        lambda, 1e-5 for means over many pixels; it goes with the variance of m: 1e-3 for single
        pixels.
    offset : bool
        Whether blends have offsets of their own (True). Not where I is an exposure time: no time,
        no light.
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
        For blends without three samples of different brightness, or that fall where irradiance
        rises.

    References
    ----------
    Wilburn, Xu and Matsushita, CVPR 2008, eq. 5; Ramsay, Monotone regression splines in action,
    1988.

    Examples
    --------
    >>> alpha = np.linspace(0, 1, 16)
    >>> bright, dim = Blend(alpha, alpha**0.5), Blend(alpha, (0.2 * alpha) ** 0.5)  # a camera with f = root
    >>> joined = join([bright, dim])
    >>> round(float(np.interp(0.5, joined.M, joined.X)), 2), round(float(joined.s[1] / joined.s[0]), 3)
    (0.25, 0.2)
    """
    state = last(join_steps(blends, count=count, smoothness=smoothness, offset=offset))
    return build_response(select_blends(blends), state.g, state.s, state.r, ends=ends)
