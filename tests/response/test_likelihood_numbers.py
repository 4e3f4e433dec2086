"""What the longer chains of `response` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded
from shots import TIMES, shots

from hdrlab.core import sampling, weights
from hdrlab.response import families, likelihood, marginal, selection, self_calibration, space

RNG = np.random.default_rng(11)
NAN, INF = np.nan, np.inf
LIGHT = RNG.lognormal(-2, 1.5, (24, 30, 3))


Z3, Z1 = shots(LIGHT), shots(LIGHT[..., 1])
DEEP = Z1.astype(np.uint16) * 257
LARGE = shots(RNG.lognormal(-2, 1.5, (60, 70)))
VALID = RNG.random(Z1.shape) > 0.02
GRID = sampling.by_grid(Z1, 60)
HAT, BELL = weights.hat(), weights.cut(weights.gaussian(), below=0.02)
C = np.array([-0.8, 0.1, 0.02])
CURVES = families.to_log(families.tabulate(32))
SPACE = space.fit_space(CURVES, 4)
SPACE256 = space.default_space(5)
TAU = np.append(np.log([0.06, 0.25]), 0)
AT = likelihood.nodes(C, TAU, 30)
MODELLED = likelihood.predict(C, TAU, AT)[0]
SOME = GRID[:25].astype(np.intp)
NEAR = likelihood.support(SOME, likelihood.table(MODELLED, 0.02))
NODES = likelihood.nodes(C, TAU, 12)
LEVELS = self_calibration.levels_by_time(Z1, TIMES, 150, valid=None)[0][0]
STACK = RNG.normal(0.5, 0.01, (4, 12, 14)) + np.linspace(0, 0.3, 14)
VIGNETTED = np.clip(
    np.multiply.outer([1, 1.9], 30 + 80 * RNG.random((40, 60)) * np.linspace(1, 0.2, 60)), 0, 255
)
VIGNETTED[1] *= 1 - 0.3 * (np.hypot(*(np.indices((40, 60)) - [[[20]], [[30]]])) > 25)
VIGNETTED = np.rint(VIGNETTED).astype(np.uint8)
PARTS = self_calibration.samples(LARGE, TIMES, pixels=2000, count=50, valid=None)


def ringed(k):
    """Return two photographs, of which one falls off to the corners, with levels on both sides of a limit."""
    rng = np.random.default_rng(k)
    a = rng.choice([3, 4, 5, 6, 90, 91, 92, 150, 248, 249, 250, 251], (17 + k % 3, 20))
    return np.stack(
        [
            a,
            np.clip(
                a
                + rng.integers(-1, 2, a.shape)
                - (selection.radius(a.shape) > 7 + k % 4) * (1 + k % 3),
                0,
                255,
            ),
        ]
    ).astype(np.uint8)


def masses(m, sigma, z):
    """Return the probabilities of levels, and their slopes."""
    return likelihood.masses(m, sigma, z)


def posterior(p):
    """Return the likelihood of each pixel, and the weights of its nodes."""
    q, k, z = NEAR.cells
    P = likelihood.masses(MODELLED[q, k], 0.02, z)[0]
    return likelihood.posterior(P, p, NEAR)


def scores():
    """Return how the likelihood of each pixel changes with each unknown, and the density of the light."""
    q, k, z = NEAR.cells
    m, J = likelihood.predict(C, TAU, AT)
    P, dm, ds = likelihood.masses(m[q, k], 0.02, z)
    own = likelihood.posterior(P, np.full(len(AT.x), 1 / len(AT.x)), NEAR)[1]
    return likelihood.scores(own, NEAR, J, dm, ds), likelihood.density(own, NEAR, len(AT.x))


def climbed(**named):
    """Return the steps of a fit."""
    return marginal.fit_steps(LEVELS, C, [0.27, 0.24], **named)


masses.__module__ = posterior.__module__ = scores.__module__ = "hdrlab.response.likelihood"
climbed.__module__ = "hdrlab.response.marginal"
LOOSE = dict.fromkeys((f"response.marginal.{name}" for name in ("climbed", "recover", "fit")), 1e-4)
CASES = recorded.named(
    of(likelihood.nodes, C, TAU, 12),
    *(of(likelihood.predict, c, TAU, NODES) for c in (C, C[:1])),
    *(of(masses, np.array(m), s, z) for m, s, z in (([0.5, 0.5, 0.1], 0.01, [127, 130, 0]), ([0.99, 1.0,
        0.2], 0.02, [255, 254, 255]))),
    of(likelihood.table, np.array([[0.5, 0.001], [0.999, 0.2]]), 0.01),
    *(of(likelihood.support, SOME, likelihood.table(MODELLED, 0.02), **k) for k in ({}, {"least": 0.01},
        {"block": 7})),
    *(of(posterior, np.full(len(AT.x), p)) for p in (1 / 90, 0.5)),
    of(scores),
    *(of(likelihood.stiffness, *a) for a in ((7, 3, 0.1), (6, 4, 2.0), (5, 2, INF))),
    *(of(marginal.unpack, np.arange(7.0), n) for n in (3, 2)),
    *(of(climbed, max_iterations=2, **k) for k in ({}, {"trust": 0.01, "stated": [0.25, 0.25]})),
    of(climbed, tolerance=500.0),
    *(of(marginal.fit, z, C, r) for z, r in ((LEVELS, [0.25]), (LEVELS[0], [0.25, 0.25]), (LEVELS * 1.0,
        [0.25, 0.25]))),
    of(marginal.fit, LEVELS, [-3.0, 2.0], [0.2, 0.3]),
    of(marginal.recover, Z1, TIMES, order=3, pixels=100),
    of(selection.temporal_average, STACK),
    *(of(selection.temporal_average, a, **k) for a, k in ((STACK[:1], {}), (STACK[:1], {"sigma": 0.2}),
        (STACK[0], {}), (STACK[:0], {}), (STACK * NAN, {}))),
    *(of(selection.spatial_average, STACK[0], **k) for k in ({}, {"size": 3})),
    *(of(selection.threshold, *a, **k) for a, k in (((), {}), ((9,), {"psi": 0.1}), ((25,),
        {"estimated": 50.0}), ((2,), {}), ((1,), {}), ((9,), {"psi": 0}), ((9,), {"psi": 1}), ((9,),
        {"estimated": 0}))),
    *(of(selection.flat, STACK[:t, :9, :9], size=n, psi=0.4) for t in (1, 2, 3, 4) for n in (2, 3, 4, 6)),
    *(of(selection.flat, a, **k) for a, k in ((STACK, {}), (STACK[:1], {}), (STACK, {"size": 3, "psi": 0.3}),
        (STACK[:1], {"sigma": 0.05, "size": 4}), (STACK, {"size": 1}), (STACK, {"sigma": 0}), (STACK,
        {"size": 2}))),
    *(of(selection.radius, s) for s in ((4, 5), (1, 3))),
    *(of(selection.circle, *VIGNETTED, **k) for k in ({}, {"tolerance": 6.0}, {"tolerance": 90.0},
        {"rings": 12})),
    *(of(selection.circle, *ringed(k), rings=6 + k % 3, tolerance=1 + k % 2) for k in range(24)),
    of(selection.circle, VIGNETTED[0] // 99, VIGNETTED[0] // 99),
    *(of(self_calibration.average, z, *n) for z, n in ((GRID, (7,)), (GRID, ()), (GRID[:3], ()), (GRID[0],
        ()), (GRID * 1.0, ()), (GRID[:0], ()), (GRID + 1, ()), (GRID - 1, ()))),
    of(self_calibration.average, np.array([[0, 9], [1, 255], *[[50, 60]] * 18, *[[255, 255]] * 3]), 2),
    of(self_calibration.held_out, *PARTS),
    *(of(self_calibration.choose_order, p, PARTS[1]) for p in (PARTS[0], PARTS[0][:1], PARTS[0][:2])),
    *(of(self_calibration.levels_by_time, z, t, 20, valid=v) for z, t, v in ((Z3, [4, 1, 9], None), (Z1,
        TIMES, VALID), (DEEP, TIMES, None), (Z1, [1, 1, 1], None))),
    of(self_calibration.samples, LARGE, TIMES, pixels=1000, count=41, valid=None),
    of(self_calibration.samples, LARGE, TIMES, valid=None),
    of(self_calibration.samples, LARGE[:, :1, :3], TIMES, valid=None),
    *(of(self_calibration.calibrate, z, TIMES, **k) for z, k in ((LARGE, {}), (Z3, {"order": 3,
        "eps": 1e-5}), (Z1, {"valid": VALID}), (Z1 * 0, {}))),
    *(of(self_calibration.find_response, z, TIMES, **k) for z, k in ((LARGE, {}), (Z3, {"order": 3}), (DEEP,
        {"order": 2}), (Z1, {"order": 2, "valid": VALID}))),
    *(of(space.fit_space, c, n) for c, n in ((CURVES, 3), (CURVES[0], 3), (CURVES * NAN, 3), (CURVES, 0),
        (CURVES[:3], 3), (CURVES[:3], 2), (CURVES, 1))),
    *(of(space.truncate, SPACE, n) for n in (2, 4, 5, 0, 1)),
    *(of(space.project, c, SPACE) for c in (CURVES[:3], CURVES[5], CURVES[:, :9])),
    of(space.reconstruct, [0.5, -1, 0.2, 0.1], SPACE),
    of(space.solve_map, np.arange(8.0).reshape(4, 2) % 5, np.array([1.0, 2, 0, 1]), np.array([0.5, 0])),
    *(of(space.fit_samples, p, v, SPACE, **k) for p, v, k in (([0.1, 0.5, 1], [-3, -1, 0.5], {}), ([0, 0.5],
        [-3, -1], {"noise": 0.5}), ([-0.1], [1], {}), ([1.1], [1], {}), ([0.5], [NAN], {}), ([0.5], [1],
        {"noise": 0}), ([[0.5]], [[1]], {}), ([0.5], [1, 2], {}))),
    *(of(space.default_space, *n) for n in ((), (2, 16))),
    *(of(space.build_equations, z, np.log(TIMES), BELL, SPACE256) for z in (GRID[:9], GRID[:3] * 0,
        np.array([[0, 9,
        0]]))),
    *(of(space.recover, z, TIMES, samples=90) for z in (Z3, Z1, DEEP)),
    of(space.recover, Z1, TIMES, samples=60, basis=SPACE256, noise=0.1, w=HAT * 3, choose=sampling.by_grid,
        valid=VALID),
    *(of(space.recover, Z1, TIMES, **k) for k in ({"basis": SPACE}, {"noise": 0})),
    *(of(space.recover, Z1, t, samples=60) for t in ([1, 1, 1], [4, 1, 0.25])),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__, LOOSE.get(function, recorded.TOLERANCE))
