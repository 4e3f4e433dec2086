"""What the functions of `diagnostics` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded
from scipy.ndimage import gaussian_filter

from hdrlab.capture import responses
from hdrlab.core import weights
from hdrlab.diagnostics import (
    consistency,
    contradictions,
    exposure_times,
    flat_patches,
    motion,
    noise,
    outlying_frames,
    plausibility,
    response_steps,
)
from hdrlab.fast.merge import merge

RNG = np.random.default_rng(41)
NAN, INF = np.nan, np.inf
BLOCKS = np.kron(RNG.lognormal(-2.3, 1.3, (15, 19)), np.ones((14, 14)))
COLOURS = np.stack([BLOCKS, 0.7 * BLOCKS, 0.5 * BLOCKS], axis=-1)
TIMES = np.array([0.25, 1.0, 4.0, 16.0])
WRONG = TIMES * [1, 1, 1.7, 1]
SWAPPED = TIMES * [1, 1, 30, 1]
B, B_WRONG = np.log(TIMES), np.log(WRONG)
G = responses.true_g("film")


def shots(scene=BLOCKS, times=TIMES, noise=0.004, curve="film", falloff=0.0):
    """Return photographs of a scene."""
    y, x = (np.linspace(-1, 1, n) for n in scene.shape[:2])
    shade = 1 - falloff * (y[:, None] ** 2 + x**2)
    taken = []
    for j, t in enumerate(times):
        shaded = scene * (shade if scene.ndim == 2 else shade[..., None]) if j % 2 else scene
        M = responses.as_response(curve).f(np.clip(t * shaded, 0, 1))
        taken.append(M + noise * np.random.default_rng(j).standard_normal(M.shape))
    return np.rint(255 * np.clip(taken, 0, 1)).astype(np.uint8)


Z1, Z3 = shots(), shots(COLOURS)
DEEP = Z1.astype(np.uint16) * 257
TINTED = shots(COLOURS * [1, 1, 1.0])
TINTED[1] = shots(COLOURS * [1.5, 1, 0.6])[1]
CORNERS = shots(falloff=0.25)
STEPPED = shots(times=TIMES * [1, 1, 0.6, 1])
PASSED = Z1.copy()
PASSED[1, 60:120, 80:150], PASSED[2, 90:140, 20:90] = 140, 60
PLAIN = np.minimum(
    shots(np.repeat([[0.4, 0.03]], [20, 12], axis=1) * np.ones((20, 1)), noise=0), 250
)
PLAIN[1, 4:12, 4:12], PLAIN[2, 12:, 8:20] = 90, 0
PART = np.zeros(PLAIN.shape, bool)
PART[:3, 4:12, 8:16], PART[:, ::4, ::4] = True, True
FLICKERED = np.rint(
    np.clip(
        Z1 * (1 + 0.15 * np.sin(np.arange(210) / 9 + 2 * np.arange(4)[:, None]))[..., None], 0, 255
    )
).astype(np.uint8)
VALID = RNG.random(Z1.shape) > 0.001
RISING = np.repeat(np.arange(30, 130, dtype=np.uint8), 10).reshape(25, 40)
E1 = merge(Z1, TIMES, G)
FOUND, FOUND3 = flat_patches.find_flat_patches(Z1), flat_patches.find_flat_patches(Z3)
H, H3 = (flat_patches.count_pairs(one.Z, one.best) for one in (FOUND, FOUND3))
Q, Q_KNOWN = response_steps.free_directions(B), response_steps.free_directions(B, known=True)
BEST = response_steps.fit_steps(H, B, Q)
WRONG_FIT = response_steps.fit_steps(H3, B_WRONG, Q)
PAIRS = response_steps.weight_pairs(H3)
SMALL = flat_patches.FlatPatches(FOUND.Z[:, :, :9, :8], FOUND.flat[:, :9, :8])
MEDIANS = consistency.measure_level_exposures(Z3, TIMES, merge(Z3, TIMES, G))
POISSON = (
    np.random.default_rng(5).poisson(
        1500 * np.clip(np.multiply.outer(TIMES, gaussian_filter(BLOCKS, 6)), 0, 1)
    )
    / 1500
)
NOISY = np.rint(65535 * np.clip(POISSON + 0.002 * RNG.standard_normal(POISSON.shape), 0, 1)).astype(
    np.uint16
)
LINEAR = np.log(np.maximum(np.arange(65536), 0.25) / 32768)
THREE = np.arange(70)[:, None] + [0, 90, 180]  # columns of three channels
AVERAGE = (NOISY * 2.0 ** (-2 * np.arange(4))[:, None, None]).mean(axis=0) / 65535


def best(found):
    """Return which patches each pair of frames shows well."""
    return found.best, found.of([0, 2]).flat


def judged(images, times, **named):
    """Return the contradictions of photographs, and what is said of them."""
    found = contradictions.find_contradictions(images, times, **named)
    names = "abcdef"
    said = [
        contradictions.warn_of_contradictions(found, names, s)
        for s in (0.014, 0.015, 0.09, 0.11, INF)
    ]
    return found, found.wrong, found.local, said


def warned(**named):
    """Return what is wrong with findings, and what is said of them."""
    nothing = {
        "stops": np.zeros(3),
        "regions": np.zeros(2),
        "significance": np.zeros(2),
        "corners": np.zeros(2),
        "cost": 0.0,
    }
    found = contradictions.Contradictions(**nothing | {k: np.asarray(v) for k, v in named.items()})
    return found.wrong, found.local, contradictions.warn_of_contradictions(found, "abcdef", 0.2)


def estimated(images, times, **named):
    """Return times that the pixels tell, and what is said of them."""
    found = exposure_times.estimate_times(images, times, **named)
    return (
        found,
        exposure_times.note(found, "abcdef"[: len(found.stops)]),
        exposure_times.doubts(found),
    )


def doubted(stops, accepted=True):
    """Return what is said of corrections."""
    found = exposure_times.Estimate(np.ones(len(stops)), np.array(stops), accepted, "because")
    return exposure_times.note(found, "abcdef"[: len(found.stops)]), exposure_times.doubts(found)


def marked():
    """Return what groups tell of the noise, of which some stand just at what counts as measured."""
    rng, groups = np.random.default_rng(2), np.split(np.arange(900), range(100, 900, 100))
    E = np.repeat(np.geomspace(0.08, 0.8, 9), 100)
    X = E * np.array([[1], [2.1]])
    Z = np.rint(128 * (X + rng.normal(0, np.sqrt(X / 900 + 0.01**2)))).astype(int)
    Z[0, 100:102], Z[0, 200:201], Z[1, 301:304], Z[:, 400:500], E[400:500] = 1, 0, 250, 128, 1
    groups[5], groups[6:] = groups[5][:60], groups[6:8]
    return noise._fit(
        Z, np.array([1.0, 2.0]), np.log(np.maximum(np.arange(256), 0.25) / 128), E, groups, 250
    )


def fainter(steps, times):
    """Return how far a curve departs from ranks, of which the longer exposure has others by these steps."""
    Z = np.stack(
        [np.arange(100, 100 + len(steps)), np.arange(100, 100 + len(steps)) + steps], axis=1
    )
    return plausibility.neighbour_errors(Z[..., None], np.array(times), G[:, None])


def accepted(images, times, stops):
    """Return whether a curve that spans some stops between the inner levels is one of a camera's."""
    g = np.maximum(np.arange(256) - 30, -30) / 195 * (stops * np.log(2)) + 20
    return plausibility.validate_response(g, images, times)[[30, 225]]


def directions(B, known):
    """Return what the free directions span."""
    Q = response_steps.free_directions(B, known=known)
    return Q @ Q.T, Q.shape


directions.__module__ = "hdrlab.diagnostics.response_steps"
marked.__module__ = "hdrlab.diagnostics.noise"
fainter.__module__ = accepted.__module__ = "hdrlab.diagnostics.plausibility"
best.__module__ = "hdrlab.diagnostics.flat_patches"
judged.__module__ = warned.__module__ = "hdrlab.diagnostics.contradictions"
estimated.__module__ = doubted.__module__ = "hdrlab.diagnostics.exposure_times"
LOOSE = dict.fromkeys(
    ("diagnostics.noise.estimate_noise", "diagnostics.noise._solve", "diagnostics.noise.marked"),
    1e-4,
)
TOLERANCE = 1e-5
CASES = recorded.named(
    *(of(consistency.measure_level_exposures, z, TIMES, e, **k) for z, e, k in ((Z1, E1, {}), (Z3, merge(Z3,
        TIMES, G), {"valid": VALID}), (DEEP, E1 * (E1 > 0.05), {}), (Z1, E1[1:], {}))),
    *(of(consistency.choose_grid, s) for s in ((210, 266), (1300, 1300, 3), (700, 2400))),
    of(consistency._median_per_level, np.repeat([3, 9, 200], [49, 50, 51]).astype(np.uint8), np.arange(150,
        dtype=np.float32) ** 2),
    *(of(f, m) for f in (consistency.measure_deviations, consistency.measure_spread) for m in (MEDIANS,
        MEDIANS + np.arange(4)[:, None, None] / 9, MEDIANS[:1])),
    of(consistency.measure_residuals, MEDIANS, G),
    *(of(judged, z, t) for z, t in ((Z1, TIMES), (Z1, WRONG), (Z3, TIMES), (TINTED, TIMES), (CORNERS, TIMES),
        (STEPPED, TIMES), (PASSED, TIMES), (Z1[:2], TIMES[:2]), (Z1, np.ones(4)), (Z1, TIMES[::-1]), (Z1[:3],
        TIMES[:3]))),
    *(of(judged, z, TIMES, valid=VALID) for z in (Z1, PASSED)),
    of(judged, np.concatenate([Z1, Z1[:1] * 0]), [*TIMES, 64.0]),
    *(of(warned, **k) for k in ({}, {"stops": [0.3, -0.3, 0], "cost": 0.06}, {"stops": [0.25, 0, 0.26],
        "cost": 0.05}, {"stops": [0.25, 0, 0.26], "cost": 0.051}, {"stops": [0.3, NAN, 0, 0.5],
        "cost": 1.0})),
    *(of(warned, **k) for k in ({"regions": [0.03, 0.03], "significance": [5, 5]}, {"regions": [0.02, 0.02],
        "significance": [5, 5]}, {"regions": [0.03, 0.3], "significance": [4, 4]}, {"regions": [0.11, 0.2]},
        {"regions": [0.03, NAN], "significance": [5, NAN]}, {"regions": [0.1, 0.1]},
        {"regions": [NAN, NAN]}, {"corners": [0.03, 0.021]}, {"corners": [0.02,
        0.02]}, {"tints": [0.1, 0.25, 0]}, {"tints": [0.1, 0.3, 0]})),
    *(of(contradictions.measure_cost, z, np.array(s)) for z in (Z1, Z3) for s in ([0, 0.5, NAN, 0], [0, 0, 0,
        0])),
    of(contradictions.measure_cost, np.zeros((4, 9, 9), np.uint8), np.ones(4)),
    of(contradictions.measure_cost, np.tile(Z1, (1, 2, 1)), np.array([0, 0.5, 0.1, 0])),
    *(of(contradictions.find_longest_run, np.array(r, bool)) for r in ([1, 0, 1, 1, 0], [0, 0], [1, 1], [1,
        0, 1])),
    *(of(contradictions.measure_disagreement, f, B, r) for f, r in ((FOUND, BEST), (FOUND3, WRONG_FIT),
        (flat_patches.find_flat_patches(CORNERS), BEST), (SMALL, BEST), (FOUND._replace(Z=FOUND.Z[..., :20],
        flat=FOUND.flat[..., :20]), BEST), (FOUND._replace(flat=FOUND.flat & (np.arange(4) > 0)[:, None,
        None]), BEST))),
    of(contradictions._tile_medians, RNG.normal(0, 0.1, 60), np.repeat([4, 7, 9, 12], [9, 10, 11, 30])),
    *(of(estimated, z, t, **k) for z, t, k in ((Z1, TIMES, {}), (Z1, WRONG, {}), (Z1, WRONG, {"g": G}), (Z3,
        WRONG, {"spread": lambda t: 1 / t.sum()}), (Z1, WRONG, {"spread": np.sum}), (Z1[:2], TIMES[:2], {}),
        (Z1[:2], WRONG[1:3], {"g": G}), (Z1 * 0, TIMES, {}), (Z1, WRONG, {"sd": 0.01}), (Z1, WRONG,
        {"gain": 0.99}), (Z1, WRONG, {"valid": VALID}), (Z1, TIMES[::-1], {}), (Z1[:3], WRONG[:3], {}))),
    *(of(exposure_times.single_out, np.array(x), np.arange(len(x)) * 1.4) for x in ([0, 0.5, 0.01, 0], [0,
        0.5, 0.07, 0], [0, 0.05, 0, 0], [0, 0.5, 0], [0.1, 0.2, 0.3, 0.9])),
    *(of(exposure_times.single_out, np.array(x) + np.arange(6.0), np.arange(6.0)) for x in ([0.0082, 0, 0.07,
        0, 0, 0], [0, 0, 0.05, 0, 0, 0])),
    *(of(exposure_times.cross_validate, f, b, q, g=g, sd=1 / 6) for f, b, q, g in ((FOUND, B, Q, None),
        (FOUND3, B_WRONG, Q, None), (FOUND, B, Q_KNOWN, G[None]), (SMALL, B, Q, None))),
    *(of(doubted, *a) for a in (([0, 0.3, -0.2, 0.004],), ([0, 0.6, 0, 0],), ([0, 0.5, 0, 0],), ([0.1, 0,
        -0.05],), ([0.08, 0, 0],), ([0.7, 0, 0],), ([0.5, 0, 0],), ([0.7, 0, 0], False))),
    *(of(flat_patches.find_flat_patches, z, **k) for z, k in ((Z1, {}), (Z3, {"valid": VALID}), (DEEP, {}),
        (Z1[:, :5, :9], {}))),
    of(flat_patches.find_flat_patches, np.tile(DEEP[1:3], (1, 9, 9))[:, :1800, :2300]),
    *(of(best, f) for f in (FOUND, FOUND3, flat_patches.find_flat_patches(PASSED))),
    *(of(flat_patches.rank_levels, z, **k) for z, k in ((Z1, {}), (Z3, {"valid": VALID}))),
    *(of(flat_patches._reduce_patches, z, n, f) for z, n, f in ((Z1[0], 7, np.minimum), (Z3[1], 14, np.add),
        (DEEP[0], 7, np.maximum))),
    of(flat_patches.find_static, np.array([[[[5, 5, 9, 0, 7]]], [[[7, 6, 6, 9, 5]]], [[[7, 9, 8, 9, 6]]]],
        np.uint8)),
    of(flat_patches.count_pairs, FOUND3.Z, FOUND3.best),
    *(of(flat_patches.checkerboard, s, **k) for s, k in (((9, 14), {}), ((5, 7), {"side": 2}))),
    *(of(motion.measure_motion, z, TIMES, G, weights.gaussian(), **k) for z, k in ((Z1, {}), (PASSED, {}),
        (FLICKERED, {}), (PASSED, {"valid": VALID}), (Z3, {}), (np.tile(PASSED, (1, 4, 1)), {}),
        (Z1[:1] * np.ones((4, 1, 1), np.uint8), {}))),
    *(of(motion.measure_motion, z, TIMES[: len(z)], G, weights.hat()) for z in (Z1 * 0, Z1[:1])),
    of(motion.measure_bands, RNG.normal(0, 9, (3, 20)).astype(np.float32), RNG.random((3,
        20)).astype(np.float32) * 20, 9),
    *(of(motion.measure_motion, z, TIMES, G, np.ones(256), valid=v) for z, v in ((PLAIN, None), (PLAIN,
        PLAIN >= 0), (PLAIN, PART), (np.stack([PLAIN] * 3, axis=-1), PART))),
    of(motion.measure_bands, np.sin(np.arange(60, dtype=np.float32) ** 2).reshape(3, 20),
        np.repeat(np.float32([[8, 20]] * 3), 10, axis=1), 5),
    of(motion.sum_blocks, Z1[:, :23, :30]),
    of(noise.estimate_noise, NOISY, TIMES, LINEAR, AVERAGE),
    *(of(noise.estimate_noise, z, TIMES, LINEAR, e) for z, e in ((NOISY, AVERAGE[1:]), (NOISY * 0, AVERAGE))),
    of(noise.estimate_noise, (NOISY[..., THREE] // 256).astype(np.uint8), TIMES, LINEAR[::257],
        AVERAGE[:, THREE]),
    of(marked),
    *(of(noise.slope, e) for e in (AVERAGE, np.eye(7)[::-1])),
    of(noise.group_flat, AVERAGE.ravel()[:500], RNG.random(500)),
    *(of(noise.scatter, np.array(y)) for y in ([1.0, 2, 3, 2, 40, 1, 2, 2, 3, 1, 2, 2, 1.5, 2.5, 2, 2, 2, 2,
        2], [1.0, 1, 1, 1, 9], [0.1, -0.2, 0.3], [0.5, 0.5])),
    of(noise._solve, np.geomspace(1e-5, 1e-2, 8), np.full(8, 1e-7), np.stack([np.geomspace(1, 900, 8),
        np.geomspace(1, 9e5, 8), np.full(8, 2.0)]), np.full(8, 200.0)),
    *(of(outlying_frames.find_outlying_frames, z, t, **k) for z, t, k in ((Z1, TIMES, {}), (Z1, SWAPPED[[0,
        1, 3, 2]], {}), (np.concatenate([Z1, shots(BLOCKS[:, ::-1], [20.0])]), [*TIMES, 20.0], {}), (Z1,
        TIMES * [1, 1, 1, 9], {}), (Z1, TIMES * [1, 1, 1, 9], {"valid": VALID}), (Z1[:3], TIMES[:3] * [1, 1,
        9], {}))),
    *(of(outlying_frames.measure_misfit, f, b) for f in (FOUND, FOUND3) for b in (B, B_WRONG)),
    *(of(plausibility.ranks, z, v) for z, v in ((Z1, None), (Z3, VALID), (Z1, VALID & False),
        (np.tile(Z1[:2], (1, 3, 3)), None))),
    *(of(plausibility.neighbour_errors, plausibility.ranks(z, None), t, np.stack([G] * (z.size // Z1.size),
        axis=-1)) for z, t in ((Z1, TIMES), (Z3, WRONG), (Z1[::-1], TIMES), (Z1, np.ones(4)))),
    *(of(plausibility.validate_response, g, z, t, **k) for g, z, t, k in ((G, Z1, TIMES, {}), (G, Z1[::-1],
        TIMES, {}), (G, Z3, TIMES[::-1], {}), (G * 3, Z1, TIMES, {}), (G * 4, Z1, TIMES, {}), (G, Z1,
        TIMES ** 2, {"valid": VALID}), (G, Z1, TIMES**4, {}), (G, Z1[:2], [1, 20], {}), (G, Z1[:2], [1, 90],
        {}))),
    *(of(plausibility.validate_response, g, Z1 // 200, TIMES) for g in (G * s for s in (1, 1.3, 2, 2.6, 3))),
    of(plausibility.ranks, Z1[:2], np.indices(Z1[:2].shape)[0] == np.arange(266) // 133),
    *(of(fainter, s, [1.0, 2.0]) for s in (np.repeat([-3, -2, 1], [4, 13, 13]), np.repeat([-3, 1], [12,
        17]))),
    *(of(plausibility.validate_response, G, np.stack([RISING, RISING - np.uint8(9) * (RISING < 80 +
        n)]), [1, 2]) for n in (0, 1, 12)),
    *(of(plausibility.validate_response, G, np.stack([RISING] * len(t)), t) for t in ([1, 16], [1, 2**3.5,
        2**7], [1, 8, 64, 512], [1, 8, 64.1, 513])),
    *(of(accepted, Z1[:2], [1, 1], stops) for stops in (12.9, 13, 13.03)),
    of(plausibility._pair, TIMES, np.array([0.1, NAN, 3])),
    *(of(response_steps.as_ascending_times, t, 3) for t in ([1, 2, 4], [1, 1, 4], [2, 1, 4], [1, 2])),
    *(of(response_steps.remove_trend, np.array(x), B) for x in ([0, 0.1, 0.2, 0.3], [0.0, 0.1, 0.5, 0.3],
        [0.3, 0.1, 0.2, 0.0])),
    *(of(directions, b, k) for b in (B, B[:2], np.zeros(3)) for k in (False, True)),
    *(of(f, h) for f in (response_steps.trust_pairs, response_steps.weight_pairs,
        response_steps.find_informative) for h in (H, H3, H * 0)),
    *(of(response_steps.solve_steps, PAIRS, B_WRONG, q, sd=0.1, smoothness=s, g=g) for q, s, g in ((Q, 1.0,
        None), (Q, 0.2, None), (Q_KNOWN, 1.0, np.stack([G] * 3)))),
    of(response_steps._penalty, PAIRS, 1, 0.5),
    *(of(response_steps.fit_steps, h, b, Q, **k) for h, b, k in ((H, B, {}), (H3, B_WRONG, {}), (H, B_WRONG,
        {"sd": 1.0, "smoothness": 0.3}))),
    of(response_steps.fit_steps, H, B_WRONG, Q_KNOWN, g=G[None]),
    *(of(response_steps.measure_biases, H3, B_WRONG, WRONG_FIT, sizes=s) for s in (False, True)),
    of(response_steps.measure_biases, H, B, BEST),
    of(response_steps.step_residuals, PAIRS, WRONG_FIT, B_WRONG),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__, LOOSE.get(function, TOLERANCE))
