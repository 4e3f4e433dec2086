"""Joining blends by a spline that can only rise (Wilburn et al., CVPR 2008, eq. 5, better posed).

I_ij  relative irradiance   of sample i in blend j
m_ij  brightness            0 to 1, from the lowest measured to the highest
s, r  scales and offsets    (n,); s of the widest blend is 1, which fixes the unit
S_k   steps                 sums B_k + B_k+1 + ... of K cubic B-splines, knots evenly over the range
c     increments            (K,) >= 0: g = sum_k c_k S_k never falls
v     slope                 g' of the round before; at B-spline k it is v_k, and h_k apart they stand
lambda  `smoothness`

A polynomial of degree 6 is stiff where a response bends and swings where it is straight, and a simplex may
stop on its way. Here every round is least squares in c, s and r with c >= 0,

    sum_ij ((g(p) - s_j I_ij - r_j) / v(p) + m_ij - p)^2 + lambda sum_k ((c / h)''_k / v_k)^2,

Gauss and Newton's form of sum_ij (m_ij - f(s_j I_ij + r_j))^2. The noise is in m; put into g, as in eq. 5, it
would be on both sides of the fit and flatten the curve. So g is taken at p, the brightness that the round
before predicts for s_j I_ij + r_j. The third differences of the spline's coefficients, second ones of its
slopes, are taken relative to the slope: a toe a hundred times flatter than the shoulder is smoothed a hundred
times less.
"""

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from hdrlab.calibration.blends import POINTS, Blend, Joined, as_blends, domain, unit, within
from hdrlab.calibration.splines import bends, steps
from hdrlab.core.steps import last

Float = NDArray[np.float64]
Rows = tuple[Float, Float, Float]
GRID = np.linspace(0, 1, POINTS)
FLAT = 1e-3  # of the mean slope: what is flatter is hardly told from a step


class State(NamedTuple):
    """After a round: the curve g and its slope v (1024,), scales s and offsets r (n,), and the cost."""

    g: Float
    v: Float
    s: Float
    r: Float
    cost: float


def slope(g: Float) -> Float:
    """Return v = g' on the grid, nowhere below FLAT of its mean."""
    return np.maximum(np.gradient(g, GRID), FLAT * (g[-1] - g[0]))


@lru_cache(maxsize=8)
def on_grid(count: int) -> Float:
    """Return S_k on the grid, which every round looks up."""
    S = steps(GRID, count)
    S.flags.writeable = False
    return S


def equations(
    blends: Sequence[Blend], p: Float, v: Float, count: int, widest: int, offset: bool
) -> list[Rows]:
    """Return A, F, b of each blend: its rows say A c - F (s, r) = b; the widest one's scale is 1, no unknown.

    p holds the blends' predicted brightnesses one after the other.
    """
    weight = 1 / np.interp(p, GRID, v)
    left = steps(p, count) * weight[:, None]
    right = p - np.concatenate([one.M for one in blends])
    systems, start = [], 0
    for j, one in enumerate(blends):
        own = slice(start, start + len(one.M))
        known = float(j == widest)
        unknown = np.column_stack([one.I, np.ones(len(one.I))])[:, int(known) : 2 if offset else 1]
        w = weight[own]
        systems.append((left[own], unknown * w[:, None], right[own] + known * one.I * w))
        start = own.stop
    return systems


def eliminate(A: Float, F: Float, b: Float) -> tuple[Float, Float]:
    """Return A and b less what the blend's own unknowns take up, (1 - Q Q^T) of them with F = Q R."""
    Q = np.linalg.qr(F)[0]
    return A - Q @ (Q.T @ A), b - Q @ (Q.T @ b)


def increments(systems: Sequence[Rows], penalty: Float, offset: bool) -> tuple[Float, float]:
    """Return c >= 0 and the cost of all blends' equations together; with offsets free, c_0 is 0."""
    rows = [np.column_stack(eliminate(*one)) for one in systems]
    rows.append(np.pad(penalty, ((0, 0), (0, 1))))
    R = np.asarray(np.linalg.qr(np.vstack(rows), mode="r"))  # K + 1 rows that say the same
    A, b = R[:, :-1].copy(), R[:, -1]
    A[:, 0] *= not offset
    c, norm = nnls(A, b)
    return c, float(norm**2)


def turn(
    blends: Sequence[Blend], p: Float, v: Float, *, count: int, smoothness: float, offset: bool
) -> State:
    """Return the State after a round, given the predicted brightnesses p and the slope v."""
    widest = int(np.argmax([np.ptp(one.M) for one in blends]))
    systems = equations(blends, p, v, count, widest, offset)
    c, cost = increments(systems, np.sqrt(smoothness) * bends(v, GRID, count), offset)
    g = on_grid(count) @ c
    if not g[-1] > g[0]:
        raise ValueError(
            "expected brightness that rises with irradiance, but the blends fit a flat curve best"
        )
    x = [np.linalg.lstsq(F, A @ c - b, rcond=None)[0] for A, F, b in systems]
    s = np.array([1.0 if j == widest else one[0] for j, one in enumerate(x)])
    r = np.array([one[-1] if offset else 0.0 for one in x])
    return State(g, slope(g), s, r, cost)


def predict(blends: Sequence[Blend], state: State) -> Float:
    """Return p = g^-1(s_j I_ij + r_j), of one blend after the other."""
    rising = state.g + 1e-12 * state.g[-1] * GRID  # so that a flat stretch has one answer
    X = [s * one.I + r for one, s, r in zip(blends, state.s, state.r, strict=True)]
    return np.interp(np.concatenate(X), rising, GRID)


def join_steps(
    blends: Sequence[Blend],
    *,
    count: int = 24,
    smoothness: float = 1e-5,
    offset: bool = True,
    rounds: int = 30,
    enough: float = 2e-5,
) -> Iterator[State]:
    """Yield the State after each round, until the curve moves by less than `enough` of its range."""
    blends = as_blends(blends)
    if count < 6 or not smoothness >= 0 or rounds < 1:
        raise ValueError(
            f"expected count >= 6, smoothness >= 0 and rounds >= 1, got {count}, {smoothness}, {rounds}"
        )
    low, high = domain(blends)
    placed = [Blend(one.I, (one.M - low) / (high - low)) for one in blends]
    p, v, before = np.concatenate([one.M for one in placed]), np.ones(POINTS), GRID
    for _ in range(rounds):
        state = turn(placed, p, v, count=count, smoothness=smoothness, offset=offset)
        yield state
        now = state.g / state.g[-1]
        if np.abs(now - before).max() < enough:
            return
        p, v, before = predict(placed, state), state.v, now


def join(blends: Sequence[Blend], *, ends: float = 0.005, **knobs: Any) -> Joined:
    """Return the inverse response that joins the blends, a rising spline.

    Parameters
    ----------
    blends : sequence of Blend
        Samples of a few mixtures, within the measured range: see `blends.blend`.
    ends : float
        The part of the samples at either end that lies outside of the curve returned: see `blends.within`.
    count : int
        K, 24 B-splines.
    smoothness : float
        lambda, 1e-5 for means over many pixels; it goes with the variance of m: 1e-3 for single pixels.
    offset : bool
        Whether blends have offsets of their own (True). Not where I is an exposure time: no time, no light.
    rounds, enough : int, float
        At most 30 rounds, fewer when the curve moves by less than 2e-5.

    Returns
    -------
    Joined
        X over M, from 0 to 1 over the measured range, with scales s and offsets r in that unit.

    Raises
    ------
    ValueError
        For blends without three samples of different brightness, or that fall where irradiance rises.

    References
    ----------
    Wilburn, Xu and Matsushita, CVPR 2008, eq. 5; Ramsay, Monotone regression splines in action, 1988.

    Examples
    --------
    >>> alpha = np.linspace(0, 1, 16)
    >>> bright, dim = Blend(alpha, alpha**0.5), Blend(alpha, (0.2 * alpha) ** 0.5)  # a camera with f = root
    >>> joined = join([bright, dim])
    >>> round(float(np.interp(0.5, joined.M, joined.X)), 2), round(float(joined.s[1] / joined.s[0]), 3)
    (0.25, 0.2)
    """
    told, state = as_blends(blends), last(join_steps(blends, **knobs))
    low, high = domain(told)
    return within(unit(low + GRID * (high - low), state.g, state.s, state.r), told, ends)
