"""What the functions of `radiance` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded

from hdrlab.capture import lens_flare, responses
from hdrlab.core import transfer, weights
from hdrlab.core.filters.scatter import GlareSpread
from hdrlab.radiance import flare, merge, ratios, reflection, scales, stuck, uncertainty

RNG = np.random.default_rng(13)
NAN, INF = np.nan, np.inf
TIMES = np.array([0.25, 1.0, 4.0])
E = RNG.lognormal(-1.5, 1.5, (12, 14, 3)).astype(np.float32)
L = E[..., 1]
G = responses.true_g("gamma")
RGBG = np.stack([G, responses.true_g("film"), G + 0.2], axis=-1)


def shots(scene=E, times=TIMES, noise=0.004):
    """Return photographs of a scene."""
    X = np.clip(np.multiply.outer(times, scene), 0, 1)
    M = X ** (1 / 2.2) + noise * np.random.default_rng(2).standard_normal(X.shape)
    return np.rint(np.clip(M, 0, 1) * 255).astype(np.uint8)


Z3 = shots()
Z3[:, 2, 3], Z3[:, 4, 4, 0], Z3[:, 5, 5], Z3[0, 6, 6], Z3[1:, 6, 6] = 255, 255, 0, 0, 255
Z1 = Z3[..., 1].copy()
Z1[:, 9, 9] = 255  # stuck, and dark around it
Z1[:, 8:11, 8] = Z1[:, 8:11, 10] = Z1[:, 8, 9] = Z1[:, 10, 9] = 20
DEEP = Z1.astype(np.uint16) * 257
VALID = RNG.random(Z1.shape) > 0.2
W = RNG.random((3, 9))
X = RNG.random((3, 9)) + 0.1
T = TIMES[:, None]
FLARED = lens_flare.add_glare(
    np.where(RNG.random((70, 80)) > 0.99, 3e3, RNG.lognormal(0, 0.7, (70, 80))),
    GlareSpread(0.05, 2.0),
)
FLARED3 = lens_flare.add_glare(np.kron(FLARED[:, :, None], [1, 0.7, 0.4]), GlareSpread(0.03))
SPOTTED = np.zeros((40, 50), np.float32) + 0.1
SPOTTED[5:8, 6:9] = 50
MIRRORED = (SPOTTED + 0.06 * SPOTTED[::-1, ::-1]).astype(np.float32)
H = transfer.histograms(shots(RNG.lognormal(-2, 1.3, (40, 50))))[0]
H16 = np.zeros((2, 1024))
H16[0, 100:300], H16[1, 380:1000] = 3, 1
FOUND = ratios.collect_equations(H[0], H[1])
READ = ratios.Equations(
    np.array([1.0, 2, 3, 4]), np.array([2.0, 4.2, 5.9, 30]), np.array([1.0, 1, 0.5, 0.2])
)
LINEAR = np.rint(255 * np.clip(np.multiply.outer([0.3, 0.9], E), 0, 1)).astype(np.uint8)
NEIGHBOURS = np.array([[1.0, 2, 3], [4, 99, 6], [7, 8, 10]])
INTERVALS = uncertainty.variance(X, X / 9, 5000, 3)


def bounded(Z, shown=True):
    """Return what clipped and dark pixels say."""
    Z = np.array(Z)[:, None, None, None]
    return merge.bound(Z, np.log(TIMES), G[:, None], 250, np.broadcast_to(shown, Z.shape))


def repaired(Z, times=TIMES, valid=None, E=L):
    """Return the pixels that are stuck, and the light with their neighbours' median."""
    light = E.copy()
    return stuck.repair_stuck(light, Z, times, valid), light


def random_histograms(k):
    """Return histograms of two photographs, with gaps."""
    rng = np.random.default_rng(k)
    return [
        np.bincount(np.clip(rng.gamma(2, 9 * m, 400), 0, 255).astype(int), minlength=256)
        for m in (1, 2 + k)
    ]


def glare(F, **named):
    """Return what is removed, and what is said of it."""
    found = flare.remove_glare(F, **named)
    return found, flare.note(found)


bounded.__module__, repaired.__module__ = "hdrlab.radiance.merge", "hdrlab.radiance.stuck"
glare.__module__ = "hdrlab.radiance.flare"
LOOSE = {"radiance.scales.fit_channel_scales": 1e-5}
CASES = recorded.named(
    *(of(flare.block_means, a, n) for a in (E, L) for n in (1, 2, 5)),
    *(of(flare.lowest_ratio, *a) for a in ((FLARED, FLARED * 0 + 2), (FLARED[:62, :81], FLARED[:62,
        :81] * 0 + 1), (FLARED * 0, FLARED), (L, L))),
    of(flare.lowest_ratio, FLARED.ravel()[:5000], FLARED.ravel()[-5000:]),
    of(flare.lowest_ratio, FLARED.ravel()[:4999], FLARED.ravel()[-4999:]),
    of(flare.subtract_glare, L, L[::-1] * 5, 0.1),
    *(of(flare.glare_steps, FLARED, p, **k) for p, k in ((2.0, {}), (3.0, {"core": 2.0}), (2.0,
        {"share": 0.04}))),
    *(of(flare.fit_power, f, p, **k) for f, p, k in ((FLARED, 2.0, {}), (FLARED, 2.5, {"core": 0.5}), (L,
        2.0, {}))),
    *(of(flare.estimate_spread, f, **k) for f, k in ((FLARED, {}), (FLARED3, {"powers": (2.0, 2.5)}), (L,
        {}), (L, {"powers": ()}))),
    of(flare.estimate_spread, np.kron(FLARED, np.ones((2, 10))), powers=(1.75, 2.0)),
    *(of(glare, f, **k) for f, k in ((FLARED, {}), (FLARED3, {"part": 0.1}), (L, {}), (E,
        {"spread": GlareSpread(0.1, 2.0, 2.0)}), (L, {"spread": GlareSpread(0.0)}))),
    *(of(glare, L, **k) for k in ({"part": 0}, {"part": 1}, {"spread": GlareSpread(1.0)},
        {"spread": GlareSpread(0.2)})),
    *(of(f, W, X, T) for f in merge.METHODS.values()),
    *(of(merge.weigh, Z3, weights.hat(), t) for t in (250, 100)),
    *(of(merge.merge_with_quality, z, t, G) for z, t in ((Z1[:1, :1, :1], [0.5]), (np.array([[[0, 1, 2, 249,
        250, 251]]] * 2, np.uint8), [1, 3]))),
    *(of(merge.merge, np.array([[[0, 1, 2, 249, 250, 251]]] * 2, np.uint8), [1, 3], G, w) for w in (None,
        weights.flat(), weights.hat() * 9)),
    of(merge.weigh, Z3, weights.hat(), 250, VALID[..., None]),
    *(of(bounded, *a) for a in (([255, 255, 255],), ([0, 0, 0],), ([0, 250, 255],), ([9, 0, 3],), ([9, 9,
        9],), ([249, 1, 250],))),
    of(bounded, [255, 255, 0], np.array([False, True, True])[:, None, None, None]),
    *(of(merge.merge, z, TIMES, g) for z, g in ((Z3, RGBG), (Z3, G), (Z1, G), (Z1, G[:, None]), (DEEP,
        responses.true_g("gamma", 65536)))),
    of(merge.merge, Z3, TIMES, G, weights.gaussian()),
    *(of(merge.merge, z, TIMES, G) for z in (Z1[0], Z1 * 1.0, Z1[:, :0], Z3[..., :2], DEEP)),
    *(of(merge.merge, Z1, t, G) for t in ([1, 2], [0, 1, 2], [1, INF, 2])),
    *(of(merge.merge, Z1, TIMES, g) for g in (G[:9], G[::-1], G * 80 / np.abs(G).max(), RGBG)),
    *(of(merge.merge_with_quality, z, TIMES, g, method=m) for z, g in ((Z3, RGBG), (Z1, G))
        for m in (*merge.METHODS, "other")),
    *(of(merge.merge_with_quality, Z1, TIMES, G, **k) for k in ({}, {"top": 0.5}, {"top": 1}, {"top": 0},
        {"top": 1.1}, {"repair": False}, {"valid": VALID})),
    of(merge.merge_with_quality, DEEP, TIMES, G, weights.gaussian()),
    *(of(merge.merge_with_quality, Z1, TIMES, G, w) for w in (np.ones(256) - 2, np.zeros(256), np.ones((256,
        3)), weights.flat())),
    *(of(ratios.collect_equations, H[0], H[1], s) for s in ("paper", "mid-step", "other")),
    *(of(ratios.collect_equations, *H16, s) for s in ("paper", "mid-step")),
    of(ratios.collect_equations, H[0], H[1]),
    of(ratios.solve_ratio, READ, np.array([True, True, True, False])),
    of(ratios.square_errors, READ, 2.0),
    *(of(ratios.ratio_steps, f, **k) for f, k in ((FOUND, {}), (READ, {"limit": 1.5}), (FOUND,
        {"tolerance": 0.01}), (FOUND, {"rounds": 1}))),
    *(of(ratios.collect_equations, *random_histograms(k), s) for k in range(6) for s in ("paper",
        "mid-step")),
    *(of(ratios.estimate_ratio, *LINEAR[::d], **k) for d in (1, -1) for k in ({}, {"scheme": "paper"})),
    *(of(ratios.estimate_ratios, z, **k) for z, k in ((Z3, {}), (LINEAR[:1], {}), (LINEAR[..., 0],
        {"scheme": "paper", "valid": VALID[:2]}), (LINEAR // 64, {}))),
    *(of(reflection.fit_reflection, SPOTTED + r * SPOTTED[::-1, ::-1]) for r in (0.19, 0.2, 0.22, 0.001)),
    *(of(reflection.fit_reflection, np.random.default_rng(k).random((9, 11)) ** 8) for k in range(9)),
    *(of(reflection.fit_reflection, f) for f in (MIRRORED, SPOTTED, E, SPOTTED * 0 + 1,
        np.stack([MIRRORED] * 3, axis=-1))),
    *(of(reflection.remove_reflection, MIRRORED, *r) for r in ((), (0.1,), (0,), (1,), (-0.1,))),
    of(reflection.remove_reflection, E, 0.2),
    of(scales.chromaticity, E),
    *(of(scales.fit_channel_scales, i, m) for i, m in ((E, E * [2, 1, 0.5]), (E, E[::-1]), (E, E[1:]), (L,
        L), (E * 0, E), (E, -E), (E[:0], E[:0]), (E * INF, E))),
    *(of(scales.fit_unit, e, *a) for e, a in ((E, (5, 4, 100)), (L, (0, 0, 3)), (L, (13, 11, 3)), (L, (14, 5,
        3)), (L, (5, 12, 3)), (L, (-1, 5, 3)), (L, (5, -1, 3)), (L * 0, (5, 5, 3)), (L, (5, 5, 0)), (L, (5,
        5, INF)))),
    of(scales.fit_unit, np.kron(L, np.ones((1, 43), np.float32)), 300, 5, 2.0),
    of(stuck.find_stuck, Z3[0], Z3[2]),
    *(of(stuck.find_stuck, a[..., None], b[..., None]) for a, b in ((Z1[0], Z1[2]), (DEEP[0], DEEP[2]),
        (NEIGHBOURS.astype(np.uint8), NEIGHBOURS.astype(np.uint8)), (NEIGHBOURS.astype(np.uint8),
        NEIGHBOURS.astype(np.uint8) + 7), (NEIGHBOURS.astype(np.uint8), NEIGHBOURS.astype(np.uint8) + 8))),
    *(of(stuck.find_stuck, a[..., None], a[..., None]) for a in (255 - NEIGHBOURS.astype(np.uint8),
        np.array([[9, 73], [72, 9]], np.uint8), np.full((131, 3), 20, np.uint8) + (np.indices((131,
        3)) == [[[129]], [[1]]]).all(0) * np.uint8(64))),
    *(of(stuck.neighbours_median, NEIGHBOURS, m) for m in (np.eye(3) > 0, np.fliplr(np.eye(3)) > 0,
        np.arange(9).reshape(3, 3) == 4)),
    *(of(stuck.find_stuck, *np.random.default_rng(k).choice([9, 16, 17, 80, 81], (2, 6, 5,
        1)).astype(np.uint8)) for k in range(12)),
    *(of(repaired, z, **k) for z, k in ((Z1, {}), (Z1, {"times": np.array([1, 1.5, 1.99])}), (Z1,
        {"times": np.array([1, 1.5, 2.0])}), (Z1, {"valid": VALID}), (Z3, {"E": E}))),
    *(of(uncertainty.variance, X, X / 9, n, r) for n, r in ((1000, 3), (50, [1.0] * 9))),
    *(of(uncertainty.inverse_variance_merge, X, X / 9, W > 0.2, TIMES, n, r) for n, r in ((1000, 3), (9, 0))),
    of(uncertainty.inverse_variance_merge, X, X / 9, W > 2, TIMES, 9, 1),
    *(of(uncertainty.merge_with_deviation, z, TIMES, g, n, *a) for z, g, n, a in ((Z3, RGBG, 1000, (5.0,
        0.02)), (Z1, G, 50, ()), (DEEP, G, 1e4, (20.0,)), (Z3, RGBG, [1e3, 2e3, 3e3], ([1, 2, 3.0], [0.1, 0,
        0.2])))),
    *(of(uncertainty.merge_with_deviation, z, t, G, 300, *a) for z, t in ((Z1[:1, :1, :1], [0.5]),
        (np.array([[[0, 1, 2, 250, 251]]] * 2, np.uint8), [1, 3])) for a in ((), (2.0,), (12.0, 0.1))),
    *(of(uncertainty.merge_with_deviation, Z3, TIMES, RGBG, *a) for a in ((0,), (INF,), (1e-12,), (5, -1),
        (5, INF), (5, 1, -0.1), (5, 1, INF), ([1, 2],), (5, [1, 2]), (5, 300.0))),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__, LOOSE.get(function, recorded.TOLERANCE))
