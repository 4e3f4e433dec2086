"""What the functions of `response` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded
from shots import TIMES, shots

from hdrlab.core import sampling, transfer, weights
from hdrlab.response import (
    debevec,
    families,
    grossberg,
    linear,
    mann,
    mitsunaga,
    polynomial,
    robertson,
)

RNG = np.random.default_rng(11)
NAN, INF = np.nan, np.inf
LIGHT = RNG.lognormal(-2, 1.5, (24, 30, 3))


Z3, Z1 = shots(LIGHT), shots(LIGHT[..., 1])
DEEP = Z1.astype(np.uint16) * 257
LARGE = shots(RNG.lognormal(-2, 1.5, (60, 70)))
VALID = RNG.random(Z1.shape) > 0.02
GRID = sampling.by_grid(Z1, 60)
HAT, BELL = weights.hat(), weights.cut(weights.gaussian(), below=0.02)
B = np.log(TIMES)
Z32, HAT32 = GRID * 32 // 256, weights.hat(32)
M = np.linspace(0, 1, 9)
C = np.array([-0.8, 0.1, 0.02])
H = transfer.histograms(Z1)[0]
EQUATIONS = grossberg.build_equations(H, TIMES, BELL)


LOOSE = dict.fromkeys(
    ("response.grossberg.solve_polynomial", "response.grossberg.recover_polynomial"), 1e-4
)
CASES = recorded.named(
    *(of(debevec.samples_needed, *a) for a in ((2,), (3,), (9, 65), (256,))),
    of(debevec.system, Z32[:4], B, 3.0, HAT32),
    *(of(debevec.solve_by_svd, a, b) for a, b in (([[2, 0], [0, 4], [1, 1]], [1, 2, 3]), ([[1, 1], [1, 1]],
        [2, 4]))),
    of(debevec.solve_by_svd, [[1, 1], [1, 1.01]], [2, 4], rtol=0.1),
    of(debevec.solve_by_svd, np.diag([1, 2e-10, 1.5e-10]), [2, 4, 1]),
    *(of(debevec.gsolve, z, b, 3.0, HAT32) for z, b in ((Z32, B), (Z32, B[:2]), (Z32[0], B), (Z32 * 2, B),
        (Z32 - 9, B), (Z32 * 0, B))),
    of(debevec.gsolve, np.array([[0, 1, 2], [2, 5, 6]]), B, 3.0, weights.hat(8)),
    *(of(debevec.recover, z, TIMES, samples=50) for z in (Z3, Z1, DEEP)),
    of(debevec.recover, Z1, TIMES[::-1], samples=50),
    of(debevec.recover, Z1, TIMES, samples=60, smoothness=5.0, w=HAT, choose=sampling.by_grid, valid=VALID),
    *(of(debevec.recover, Z1, t, samples=9) for t in ([1, 1, 1], [1, 2])),
    of(debevec.straighten_toe, np.arange(12.0).reshape(6, 2), np.array([0, 0, 1, 1, 1, 0])),
    *(of(families.power, M, g) for g in (0.5, 2)),
    *(of(families.toe, M, g, s) for g, s in ((2.0, 0.25), (1.6, 0.08))),
    *(of(f, M, *a) for f, a in ((families.film, (0.1, 1.2)), (families.logarithm, (2,)), (families.cubic,
        (0.3,)), (families.shoulder, (0.4,)))),
    of(families.generate_curves, np.array([0.1, 0.4])),
    *(of(families.level_brightness, n) for n in (5, 256)),
    *(of(families.tabulate, *n) for n in ((), (6,))),
    of(families.to_log, families.tabulate(7)),
    of(families.invert_curves, [[0, 0.2, 0.5, 1], [0, 0, 0.6, 1]], [[0, 0.5, 0.5, 1], [0, 0.1, 0.1, 0.9]],
        n=9),
    of(families.invert_curves, [0, 0.3, 1], [0, 0.6, 1]),
    *(of(families.invert_curves, x, m, n=5) for x, m in (([0, 1], [0, 1, 2]), ([0, NAN], [0, 1]), ([1, 0],
        [0, 1]), ([0, 1], [1, 0]), ([0, 1], [1, 1]))),
    of(grossberg.comparagram, Z1[0], Z1[1]),
    of(grossberg.comparagram, DEEP[0], DEEP[1]),
    *(of(grossberg.build_equations, H, t, w) for t, w in ((TIMES, BELL), (TIMES, HAT), (np.array([1, 1,
        4.0]), HAT))),
    *(of(grossberg.build_pixel_equations, GRID, t, BELL) for t in (TIMES, np.array([4.0, 4, 1]))),
    of(grossberg.interpolate_levels, np.array([0.3, 2.0, 3.6]), 5),
    of(grossberg.interpolate_levels, np.array([0.3, 2.0, 254.6])),
    *(of(grossberg.solve_table, EQUATIONS, BELL, **k) for k in ({}, {"smoothness": 0.3}, {"smoothness": 0},
        {"smoothness": INF})),
    of(grossberg.solve_table, EQUATIONS._replace(weight=EQUATIONS.weight * 0), BELL),
    *(of(grossberg.solve_polynomial, EQUATIONS, **k) for k in ({"order": 3}, {"order": 4, "n": 300},
        {"order": 0}, {"order": 21}, {"order": 1})),
    of(grossberg.solve_polynomial, EQUATIONS._replace(weight=EQUATIONS.weight * 0)),
    *(of(grossberg.recover, *a, **k) for a, k in (((Z3, TIMES), {}), ((Z1, TIMES), {"smoothness": 1.0,
        "valid": VALID}), ((DEEP, TIMES), {}), ((Z1, [1, 1, 1]), {}))),
    *(of(grossberg.recover_polynomial, *a, **k) for a, k in (((Z3, TIMES), {"order": 3}), ((Z1, TIMES),
        {"order": 4, "valid": VALID}), ((Z1, [1, 1, 1]), {}))),
    of(grossberg.recover_polynomial, Z1, TIMES),
    *(of(linear.curve, *n) for n in ((), (9,))),
    *(of(linear.recover, z, t) for z, t in ((Z1, TIMES), (DEEP, TIMES), (Z1, [1, 2]))),
    *(of(mann.descend, transfer.brightness_transfer(H[1], H[0]), s, **k) for s, k in ((200.0, {}), (249.0,
        {"low": 30.0}), (3.0, {}), (255.0, {}))),
    of(mann.descend, np.r_[np.full(20, 19.6), np.full(20, 12.0), np.full(20, 20.0)], 59.0),
    *(of(mann.build_ladders, H, t, **k) for t, k in ((TIMES, {}), (np.array([1, 1, 2.0]), {"starts": 3,
        "low": 20.0}))),
    *(of(mann.fit_exponent, [(np.array(s), 0.5) for s in one], **k) for one, k in (([[100, 70.0, 50]], {}),
        ([[100, 70.0], [90, 60, 45.0]], {"alpha": 4.0}), ([[9.0]], {}))),
    *(of(mann.power_law, g, **k) for g, k in ((0.5, {}), (0.4, {"alpha": 3.0}), (2, {"n": 9}))),
    *(of(mann.recover, *a, **k) for a, k in (((Z3, TIMES), {}), ((Z1, TIMES), {"alpha": 6.0, "starts": 3,
        "valid": VALID}), ((DEEP, TIMES), {}))),
    *(of(mann.recover, Z1, TIMES, **k) for k in ({"alpha": -1}, {"alpha": 65}, {"alpha": 64}, {"starts": 0},
        {"starts": 1})),
    *(of(mann.recover, Z1, t) for t in ([1, 1, 1], [4, 1, 0.25])),
    of(mitsunaga.terms, M, 4),
    of(mitsunaga.terms, M, 1),
    *(of(mitsunaga.value, M, c) for c in (C, [0.5])),
    of(mitsunaga.in_range, np.array([[0.05, 0.051, 0.5], [0.3, 0.979, 0.98], [0.3, NAN, 0.5]])),
    of(mitsunaga.neighbours, np.array([[0.05, 0.051, 0.5], [0.3, 0.97, 0.99], [0.3, NAN, 0.5]]), 3),
    of(mitsunaga.gram, mitsunaga.terms(M, 3), mitsunaga.terms(M**2, 3), np.arange(9) % 2, np.array([0.3,
        0.5])),
    of(mitsunaga.coefficients, np.array([[3.0, 1, 0.5], [1, 2, 0.1], [0.5, 0.1, 1]])),
    of(mitsunaga.coefficients, np.zeros((3, 3))),
    of(mitsunaga.coefficients, np.array([[3.0, 1, 1], [1, 2, 2], [1, 2, 2]])),
    of(mitsunaga.fit_steps, GRID[None] / 255, TIMES[:-1] / TIMES[1:], 3),
    of(mitsunaga.fit_steps, GRID[None] / 255, np.array([0.4, 0.4]), 4, eps=1e-5, max_iterations=4),
    *(of(mitsunaga.curve, c, *n, **k) for c, n, k in ((C, (), {}), (C, (16,), {}), ([-3.0], (), {}), ([-3.0],
        (), {"least": 0.05}))),
    *(of(mitsunaga.recover, z, t, **k) for z, t, k in ((Z3, TIMES, {}), (Z1, TIMES[::-1], {"order": 3,
        "eps": 0.1}), (DEEP, TIMES, {}), (LARGE, TIMES, {}))),
    *(of(mitsunaga.recover, z, TIMES) for z in (Z1[0], Z1 * 1.0, Z1[:, :0], Z3[..., :2], Z1 * 0, Z1[:2])),
    *(of(mitsunaga.recover, Z1, t) for t in ([0, 1, 2], [1, 2, INF])),
    *(of(f, M, C) for f in (polynomial.slope, polynomial.brightness)),
    *(of(polynomial.misfit, GRID[:9] / 255, r, C) for r in (0.25, np.array([0.2, 0.3]))),
    *(of(polynomial.limit_slope, c, **k) for c, k in ((C, {}), ([-1.0, 0.5], {}), ([-3.0], {}), ([-3.0],
        {"least": 0.2}), ([-0.99], {}))),
    *(of(robertson.irradiance, GRID[:9], TIMES, robertson.linear(), w) for w in (HAT, BELL)),
    of(robertson.update, np.array([[0, 1, 2], [1, 2, 3], [0, 0, 1]]), TIMES, np.array([1.0, 2, NAN]), 5),
    of(robertson.update, GRID, TIMES, np.arange(len(GRID)) + 1.0),
    *(of(robertson.linear, *n) for n in ((), (7,))),
    *(of(robertson.fill, np.array([9, NAN, 2, 3, NAN, 6, 8.0]), np.array(w)) for w in ([0, 0, 1, 1, 1, 0, 0],
        [0, 1, 1, 1, 1, 1, 1])),
    *(of(robertson.recover_steps, GRID, t, BELL, **k) for t, k in ((TIMES, {"max_iterations": 3}), (TIMES,
        {"tolerance": 0.05}), ([1, 1, 1], {}))),
    *(of(robertson.recover, z, TIMES, samples=n) for z, n in ((Z3, 50), (Z1, 80))),
    of(robertson.recover, Z1, TIMES, samples=60, w=HAT, choose=sampling.by_grid, valid=VALID),
    *(of(robertson.recover, Z1, t, samples=60) for t in ([4, 1, 0.25], [1, 2], [0, 1, 2], [1, 2, INF])),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__, LOOSE.get(function, recorded.TOLERANCE))
