"""What the functions of `radiance.deghosting` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded
from scipy.ndimage import gaussian_filter

from hdrlab.capture import responses
from hdrlab.core import weights
from hdrlab.radiance import merge
from hdrlab.radiance.deghosting import deviation, frames, ghosts, reference, regions

RNG = np.random.default_rng(17)
TIMES = np.array([0.25, 1.0, 4.0])
G = responses.true_g("gamma")
LIGHT = gaussian_filter(RNG.lognormal(-1.3, 1.6, (46, 52, 3)), (1.5, 1.5, 0))
HAT = weights.hat()


def shots(scene=LIGHT, times=TIMES, moves=(None, (8, 9), (9, 20))):
    """Return photographs of a scene, in which a bright thing moves."""
    taken = []
    for j, (t, at) in enumerate(zip(times, moves, strict=True)):
        X = t * scene
        if at is not None:
            X[at[0] : at[0] + 12, at[1] : at[1] + 10] = 0.08 * t
        M = np.clip(X, 0, 1) ** (1 / 2.2) + 0.004 * np.random.default_rng(j).standard_normal(
            X.shape
        )
        taken.append(np.rint(np.clip(M, 0, 1) * 255))
    return np.array(taken, np.uint8)


Z3 = shots()
Z1 = Z3[..., 1].copy()
STILL = shots(moves=(None, None, None))
VALID = RNG.random(Z1.shape) > 0.03
E3 = merge.merge_with_quality(Z3, TIMES, G).E
E1 = merge.merge_with_quality(Z1, TIMES, G).E
TAKEN = frames.calibrate_frames(Z3, TIMES, G, E3)
SHOWN = frames.calibrate_frames(Z1, TIMES, G, E1, valid=VALID)
FOUND = deviation.measure_deviation(TAKEN, HAT)
LABELS = np.zeros((46, 52), np.int32)
LABELS[5:20, 8:24], LABELS[30:36, 40:50] = 1, 2
BOX = (slice(3, 25), slice(2, 40))
SMALL = (slice(0, 9), slice(40, 52))
KNOWN, OTHER = (reference.read_frame(TAKEN, j, BOX) for j in (0, 1))
MASKED, DARKER = (reference.read_frame(SHOWN, j, SMALL) for j in (2, 0))
BOUNDED = reference.Estimate(
    np.geomspace(0.2, 4, 64), np.full(64, 0.003), np.ones(64, bool), np.zeros(64), np.ones(64)
)
SCORE = np.zeros((12, 14), np.float32)
SCORE[3:6, 4:7], SCORE[8, 9:13], SCORE[9:11, 9:11] = 1.5, 2, 3
SEED = SCORE > 2.5
RHO = RNG.normal(0.05, 0.03, 6000)
LEVELS = RNG.integers(0, 90, 6000)
NOISE = frames.level_noise(np.stack([G]))[0]
STACK = STILL.copy()
STACK[:, 6, 9], STACK[:2, 30:33, 3:9], STACK[2, 30:33, 3:9], STACK[0, 40:, 40:] = 255, 10, 250, 255


def removed(images=Z3, **named):
    """Return what is found and repaired, and what is said of it."""
    found = ghosts.remove_ghosts(images, TIMES, G, **named)
    return found, ghosts.note(found, ["a", "b", "c"])


def noted(labels, references):
    """Return what is said of some regions."""
    found = ghosts.Ghosts(E1, E1, labels, np.array(references), VALID, E1)
    return ghosts.note(found, ["a", "b", "c"])


def elsewhere(taken, E):
    """Return where one frame is clipped, and others say that it is darker."""
    return deviation.find_clipped_elsewhere(taken, E)


removed.__module__ = noted.__module__ = "hdrlab.radiance.deghosting.ghosts"
elsewhere.__module__ = "hdrlab.radiance.deghosting.deviation"
CASES = recorded.named(
    of(deviation.weighted_variance, RNG.random((3, 9)), RNG.random((3, 9)) - 0.2),
    of(deviation.weighted_variance, RNG.random((3, 4)), np.zeros((3, 4))),
    *(of(deviation.measure_deviation, t, w) for t in (TAKEN, SHOWN) for w in (HAT, weights.gaussian())),
    of(deviation.measure_deviation, frames.calibrate_frames(np.repeat(Z1, 6, axis=1), TIMES, G, np.repeat(E1,
        6, axis=0)), HAT),
    *(of(elsewhere, t, e) for t, e in ((TAKEN, E3), (TAKEN, E3 / 3), (SHOWN, E1[..., None] / 3), (TAKEN,
        E3 / 8))),
    *(of(deviation.moment_tables, TAKEN, w) for w in (HAT, HAT * 2 + 1, HAT - 1, HAT * 0, np.ones((256, 3)))),
    *(of(deviation.local_extremes, a, slice(*s)) for a in (Z3[0], Z1[1][..., None]) for s in ((0, 9), (9,
        46), (5, 6), (0, 46), (40, 60))),
    *(of(deviation.score_contradiction, FOUND, tau=t, edge=e) for t, e in ((0.1, 0.35), (0.05, 1.0))),
    of(frames.level_noise, np.stack([G, G[::-1]])),
    of(frames.level_noise, responses.true_g("gamma", 65536)[None]),
    *(of(frames.calibrate_frames, z, TIMES, G, e, **k) for z, e, k in ((Z3, E3, {}), (Z1, E1,
        {"valid": VALID}), (Z1.astype(np.uint16) * 257, E1, {}), (Z1, E3, {}))),
    of(frames.calibrate_frames, np.kron(Z1[:2], np.ones((1, 20, 20), np.uint8)), TIMES[:2], G, np.kron(E1,
        np.ones((20, 20)))),
    *(of(frames.fit_bias, LEVELS, r, NOISE) for r in (RHO, RHO + 0.21, RHO * 9, RHO / 9)),
    *(of(frames.fit_bias, LEVELS[:n], RHO[:n], NOISE) for n in (90, 900)),
    of(frames.fit_bias, np.repeat([20, 60], [100, 99]), np.full(199, 0.1), NOISE),
    *(of(f, t, LABELS) for f in (frames.mean_losses, frames.best_exposures) for t in (TAKEN, SHOWN)),
    *(of(ghosts.detect_motion, FOUND, tau=t, edge=e, margin=m) for t, e, m in ((0.1, 0.35, 4), (0.05, 0.2,
        1), (9.0, 9.0, 4), (0.4, 0.35, 2), (0.2, 2.0, 2))),
    *(of(ghosts.find_contradictions, TAKEN, BOX, j, E3[BOX]) for j in (0, 2)),
    *(of(ghosts.region_steps, TAKEN, E3, LABELS > 0, m, choose=partial) for m, partial in ((2,
        lambda found: np.full(found.max(), 1)), (4, lambda found: frames.best_exposures(TAKEN, found)))),
    *(of(ghosts.select_frames, t, BOX, 1, alone=a) for t in (TAKEN, SHOWN) for a in (True, False)),
    *(of(removed, **k) for k in ({}, {"fixed": 1}, {"alone": True}, {"most": 5.0}, {"images": STILL},
        {"images": STACK}, {"fixed": 3}, {"fixed": -1})),
    *(of(removed, Z1, **k) for k in ({}, {"valid": VALID}, {"valid": VALID, "alone": True},
        {"w": weights.gaussian()})),
    *(of(noted, *a) for a in ((LABELS, [0, 2]), (LABELS * 0, []), (LABELS * 0 + 1, [1]),
        ((np.arange(92) < 46).repeat(26).reshape(46, 52), [1]))),
    *(of(reference.read_frame, t, j, b) for t in (TAKEN, SHOWN) for j, b in ((0, BOX), (2, SMALL))),
    *(of(reference.read_frame, TAKEN._replace(images=np.where(Z3 < 120, 0, Z3)), j, SMALL) for j in (0, 1)),
    *(of(reference._violates, BOUNDED, BOUNDED._replace(low=low, high=high), 0.2) for low, high in ((0, 1),
        (1, 9))),
    *(of(reference.find_consistent, a, b, tau=t) for a, b in ((KNOWN, OTHER), (OTHER, KNOWN), (MASKED,
        DARKER)) for t in (0.05, 0.2)),
    *(of(reference.join, a, b, w) for a, b, w in ((KNOWN, OTHER, np.tile([True, False], (22, 19))), (MASKED,
        DARKER, np.ones((9, 12), bool)))),
    *(of(reference.order_by_exposure, j, np.array(t)) for j in (0, 1, 3) for t in ([1, 4, 0.25, 2.0], [0.5,
        1, 2, 1.0])),
    *(of(reference.consistent_steps, t, j, b) for t, j, b in ((TAKEN, 1, BOX), (SHOWN, 0, SMALL))),
    *(of(reference.find_consistent_frames, t, 2, b) for t, b in ((TAKEN, BOX), (SHOWN, SMALL))),
    *(of(regions.find_seeds, s) for s in (SCORE, np.where(SCORE > 0, 1, SCORE), SCORE[:5, :6])),
    *(of(regions.grow, SEED, SCORE > 0, n) for n in (0, 1, 2, 9)),
    *(of(regions.dilate, m, n) for m in (SEED, SCORE < 1, SCORE > 9) for n in (0, 1, 2, 3)),
    *(of(regions.label, m) for m in (SCORE > 1, SCORE > 9, np.eye(4) > 0)),
    *(of(regions.feather, LABELS, n) for n in (0, 1, 4)),
    of(regions.blend, np.float32([[1, 2, 0, 4, 3, 9]]), np.float32([[4, 0, 3, 1, 7, 3]]), np.float32([[0.5,
        0.3, 0.6, 0, 1, 0.2]])),
    of(regions.blend, E3[:4, :5], E3[5:9, :5], np.linspace(0, 1, 20, dtype=np.float32).reshape(4, 5)),
    *(of(regions.pad_box, BOX, n, (46, 52)) for n in (0, 2, 30)),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__)
