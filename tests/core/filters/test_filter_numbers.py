"""What the filters of `core` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded

from hdrlab.core.filters import bilateral, blur, guided, mosaic, poisson, pyramid, scatter, warp

RNG = np.random.default_rng(5)
V = RNG.random((9, 12)).astype(np.float32)
V64, P64 = RNG.normal(0, 1, (8, 11)), RNG.normal(0, 1, (8, 11))
RGB = RNG.random((7, 8, 3)).astype(np.float32)
LARGE = RNG.random((17, 14)).astype(np.float32)
INF, NAN = np.inf, np.nan
BAD = np.where(np.eye(9, 12) > 0, np.nan, V)
CHANNELS = RNG.integers(0, 3, (7, 8))
G = RNG.normal(0, 1, (2, 5, 6))
LAMP = np.zeros((9, 12), np.float32)
LAMP[4, 5], LAMP[0, 0] = 100, 7
TILTED = np.array([[1.02, 0.03, -0.4], [-0.02, 0.98, 0.7], [1e-3, -2e-3, 1]])
THREE = np.stack([np.eye(3), TILTED, warp.turn((20, 30), 3, (1.5, -2.2))])
SHIFTS = [[0, 0], [3, -1], [-2, 4]]
SHIFT = warp.as_homographies([[3, -4]])[0]
FLIP = np.array([[-1.0, 0, 29], [0, 1, 0], [0, 0, 1]])
SQUARE = np.array([[0.0, 0], [10, 0], [10, 8], [0, 8]])
LEANING = np.array([[1.0, -0.5], [11, 0.2], [9.5, 8.3], [-0.2, 7]])
WALLS = np.eye(3) + np.array([[0, 0, 0], [0, 0, 0], [-0.05, 0, 0]])


def transformed(shape, power, core=1.0):
    """Return K itself, of which the transform is taken."""
    found = scatter.spread_transform(shape, power, core)
    return np.fft.irfft2(found).astype(np.float32)


def spread(E, *args):
    """Return what scatters."""
    return scatter.scatter(E, scatter.spread_transform(E.shape, *args))


transformed.__module__ = spread.__module__ = "hdrlab.core.filters.scatter"
CASES = recorded.named(
    *(of(bilateral.bilateral, V, sigma_s=s, sigma_r=r) for s, r in ((1, 0.4), (1.4, 0.1), (5, 2), (0.2, 1))),
    *(of(bilateral.bilateral, V, sigma_s=s, sigma_r=r) for s, r in ((0, 1), (INF, 1), (1, 0), (1, INF))),
    *(of(bilateral.bilateral, a, sigma_s=1, sigma_r=1) for a in (V[0], V[:0], BAD, V[:1, :1])),
    *(of(blur.gaussian, V, s) for s in (0.7, 2.5, 0, INF)),
    *(of(blur.gaussian, a, 1) for a in (V[0], V[:0], RGB)),
    *(of(blur.blur_matrix, n, k) for n, k in ((4, [1, 2, 3]), (6, [1, 2, 3, 2, 1]), (2, [0.5, 1, 0.5]))),
    *(of(guided.window_mean, V64, r) for r in (1, 2)),
    of(guided.lines, V64, P64, radius=1, epsilon=0.1),
    *(of(guided.guided, V64, *p, radius=2, epsilon=0.3) for p in ((), (P64,), (P64[1:],), (P64 * NAN,))),
    *(of(guided.guided, a, radius=1, epsilon=1) for a in (V64[0], BAD)),
    *(of(guided.guided, V64, radius=r, epsilon=e) for r, e in ((1, 1), (0.9, 1), (0, 1), (1, 0), (1, INF))),
    *(of(mosaic.tile, mosaic.BAYER, s) for s in ((3, 5), (1, 1), (0, 2), (2,), (2, 0), (2, 2, 2))),
    *(of(mosaic.tile, p, (4, 5)) for p in ([[0, 1, 2]], [0, 1], [[], []])),
    *(of(mosaic.sample, a, CHANNELS) for a in (RGB, RGB[..., :2], RGB[..., 0], RGB[1:])),
    *(of(mosaic.as_channels, c, (2,)) for c in ([0, 2], [0, 3], [-1, 0], [1, 1, 1], [1.0, 2.0], [0.5, 1])),
    of(mosaic.demosaic, RGB[..., 0], mosaic.tile(mosaic.BAYER, (7, 8))),
    of(mosaic.demosaic, RGB[..., 0], CHANNELS),
    of(mosaic.demosaic, V64, np.full((8, 11), 2)),
    of(mosaic.demosaic, (RGB[..., 0] * 255).astype(np.uint8), CHANNELS),
    *(of(poisson.gradient, a) for a in (V, V[:1], G[0])),
    *(of(poisson.divergence, a) for a in (G, G[0], RGB)),
    of(poisson.laplacian, G[1]),
    of(poisson.eigenvalues, 5),
    *(of(poisson.solve, a) for a in (G[0] - G[0].mean(), V - V.mean(), V[0], V[:0], G[0])),
    *(of(pyramid.reduce, a) for a in (V, LARGE, RGB, V[0], V[:1], V[:2, :2])),
    *(of(pyramid.expand, V, s) for s in ((17, 23), (18, 24), (17, 24), (18, 25), (3, 18, 23))),
    *(of(pyramid.expand, V[:1, :2], s) for s in ((1, 3), (2, 4))),
    *(of(pyramid.interpolate, V, s) for s in ((17, 23), (18, 24))),
    *(of(pyramid.gaussian, LARGE, n) for n in (1, 3, 9)),
    *(of(pyramid.laplacian, a, n) for a in (LARGE, RGB) for n in (1, 4)),
    of(pyramid.collapse, [LARGE, V, V[:5, :6]][:1]),
    of(pyramid.collapse, [LARGE, LARGE[:9, :7] * 2, LARGE[:5, :4]]),
    *(of(pyramid.depth, s, n) for s in ((5, 9), (1, 1), (64, 65), (3, 64, 63), (32, 99)) for n in (2, 3, 32)),
    *(of(pyramid.half_shape, s) for s in ((5, 8), (3, 7, 1))),
    *(of(scatter.validate_spread, scatter.GlareSpread(*s)) for s in ((0,), (0.5, 2, 3), (1,), (-0.1,),
        (0.999, INF))),
    *(of(scatter.validate_spread, scatter.GlareSpread(0.1, *s)) for s in ((0,), (2, 0), (2, INF), (0.1,
        0.1))),
    *(of(transformed, s, p, c) for s, p, c in (((5, 7), 2.0, 1.0), ((4, 4, 3), 3.0, 0.5), ((11, 13), 2.5,
        2.0))),
    of(transformed, (5, 6), 2.5),
    *(of(spread, a, 2.5) for a in (LAMP, RGB, V[:, :7], V[:1])),
    of(spread, V, 2.0, 3.0),
    *(of(warp.as_homographies, a) for a in (SHIFTS, THREE, THREE * 2, TILTED, THREE * 0, [], [["a", "b"]],
        [[NAN, 1]])),
    *(of(warp.as_homographies, a) for a in ([[1.5, 2]], THREE * [1, 1, 0], [[1, 2, 3]],
        np.eye(3)[None] * 1e-5)),
    *(of(warp.as_homographies, SHIFTS, n) for n in (3, 2)),
    *(of(warp.turn, (20, 30), d, o, scale=s) for d, o, s in ((0, (1, 2), 1), (5, (0.5, -1), 1.1), (-90, (0,
        0), 1))),
    of(warp.turn, (21, 30, 3), 7),
    of(warp.corners, (4, 7, 3)),
    of(warp.apply, TILTED, SQUARE),
    of(warp.apply, THREE, SQUARE),
    of(warp.through, SQUARE, LEANING),
    of(warp.corner_distance, TILTED, np.eye(3), (20, 30)),
    of(warp.corner_distance, SHIFT, np.eye(3), (9, 9)),
    *(of(warp.corner_distance, THREE, np.eye(3), s) for s in ((20, 30), (5, 5))),
    *(of(warp.chain_homographies, o, THREE[1:][: len(o) - 1]) for o in ([0, 1, 2], [2, 0, 1], [1, 0], [0])),
    of(warp.chain_homographies, [3, 1, 0, 2], THREE),
    of(warp.chain_homographies, [0, 1, 2, 3, 4], [TILTED, TILTED @ FLIP, TILTED.T, TILTED]),
    *(of(warp.common_rectangle, THREE * [[[s, s, s]]], (40, 30, 3)) for s in (1, -1)),
    *(of(warp.common_rectangle, [[0, 0], d], (9, 12)) for d in ([8, 0], [9, 0], [0, 11], [0, 12], [2.5,
        -3.5])),
    *(of(warp.common_rectangle, np.eye(3)[None] + [[0, 0, 0], [0, 0, 0], [a, b, 0]], (20, 30)) for a,
        b in ((-0.03, 0), (-1 / 29, 0), (0, -1 / 19), (0.01, -0.02), (-0.04, 0.01))),
    *(of(warp.common_rectangle, a, s) for a in (SHIFTS, THREE, FLIP[None], WALLS[None]) for s in ((20, 30),
        (9, 7))),
    *(of(warp.common_rectangle, [[0, 0], d], (4, 6)) for d in ([0, 5], [0, 6], [3, 0], [-4, 0], [0.4, 0.6])),
    *(of(warp.common_rectangle, warp.turn((30, 40), d)[None], (30, 40)) for d in (5, 30, 90, 180)),
    *(of(warp.common_rectangle, [[0, 0], [1.0005, -0.0005]], s) for s in ((6, 1), (1, 6), (8, 9))),
    of(warp.common_rectangle, warp.turn((30, 40), 10, (3, 1))[None] @ TILTED, (30, 40)),
    *(of(warp.sample, a, TILTED, s) for a in (V, RGB) for s in ((6, 7), (10, 13))),
    of(warp.sample, LAMP, warp.as_homographies([[0.3, 0.6]])[0], (9, 12)),
    *(of(warp.nearest, a, TILTED, (8, 9)) for a in (V, RGB)),
    *(of(warp.before, a, TILTED, (10, 13, 3)) for a in (V, RGB)),
    of(warp.sample, RGB, TILTED, (10, 13, 3)),
    of(warp.sample, V * 7 - 3, TILTED, (12, 15)),
    *(of(warp.before, a, TILTED, (10, 13)) for a in (V, RGB)),
    of(warp.before, V > 0.5, warp.as_homographies([[-0.5, 2]])[0], (9, 12)),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__)
