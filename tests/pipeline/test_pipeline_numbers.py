"""What the functions of `pipeline` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded
from scipy.ndimage import zoom

from hdrlab import pipeline
from hdrlab.align import mtb
from hdrlab.capture import responses
from hdrlab.core.bracket import bracket
from hdrlab.core.filters import warp
from hdrlab.diagnostics import contradictions
from hdrlab.diagnostics.registration import Validation
from hdrlab.pipeline import (
    alignment,
    assembly,
    catalogue,
    certainty,
    recovery,
    registration,
    stages,
    timing,
)
from hdrlab.response import space

RNG = np.random.default_rng(47)
NAN, INF = np.nan, np.inf
TIMES = np.array([0.25, 1.0, 4.0])
BLOCKS = np.kron(RNG.lognormal(-1.6, 1.2, (8, 10)), np.ones((14, 14)))
SCENE = zoom(RNG.lognormal(-2, 1.3, (30, 36)), 4)[:118, :140].clip(1e-3)
G = responses.true_g("film")


def shots(scene=BLOCKS, times=TIMES, moves=((0, 0),) * 3, noise=0.004):
    """Return photographs of a scene, each from another place."""
    taken = []
    h, w = scene.shape[0] - 12 * bool(np.any(moves)), scene.shape[1] - 12 * bool(np.any(moves))
    for j, (t, (y, x)) in enumerate(zip(times, moves, strict=True)):
        X = np.clip(t * scene[y : y + h, x : x + w], 0, 1)
        taken.append(responses.film(X) + noise * np.random.default_rng(j).standard_normal(X.shape))
    return np.rint(255 * np.clip(taken, 0, 1)).astype(np.uint8)


Z1 = shots()
Z3 = np.stack([Z1, Z1 // 2, np.minimum(Z1, 200)], axis=-1)
SHIFTED = shots(SCENE, moves=((6, 6), (3, 8), (9, 1)))
COLOUR = np.stack([SHIFTED] * 3, axis=-1)
VALID = RNG.random(Z1.shape) > 0.002
TAKEN, TAKEN3 = bracket(Z1, TIMES, valid=VALID), bracket(Z3, TIMES)
WRONG = bracket(shots(BLOCKS, TIMES, noise=0.002), TIMES * [1, 1.5, 1])
FOUR = bracket(shots(BLOCKS, [0.25, 1, 4, 16], ((0, 0),) * 4), [0.25, 1, 7, 16])
LINEAR = bracket(
    np.rint(65535 * np.clip(np.multiply.outer(TIMES, BLOCKS), 0, 1)).astype(np.uint16),
    TIMES,
    linear=True,
)
SAME = TAKEN3._replace(times=np.ones(3))
STATE = assembly.Assembly(
    "merge",
    TAKEN,
    np.array([[0, 0], [1, 2], [3, 4]]),
    g=G,
    E=BLOCKS.astype(np.float32),
    quality=(BLOCKS > 0.5).astype(np.uint8),
    homographies=np.stack([np.eye(3)] * 3),
)
SURE = Validation(0, 1, np.eye(3), (0.0, 0.0), 0.0, 0.1, 0.1, 0.9, True, "")
TILT = warp.turn((9, 9), 1)
GRAIN = np.random.default_rng(5).integers(0, 256, (40, 48)).astype(np.uint8)
DUSK = np.where(GRAIN < 100, 8, np.maximum(GRAIN // 2, 20)).astype(np.uint8)  # nothing below 8
COARSE = np.kron(GRAIN[:20, :24], np.ones((2, 2), np.uint8))
CHESS = np.where(
    np.indices(COARSE.shape).sum(axis=0) % 2, COARSE, 255 - COARSE
)  # gray at half the size
STEPPED = shots(SCENE, TIMES[:2], ((6, 6), (6, 7)))
PHOTOGRAPHS = list(alignment.photograph_pairs(SHIFTED))


def registered(images, *args, **named):
    """Return how photographs lie on each other."""
    found = alignment.register(images, *args, **named)
    return (
        found.homographies,
        found.method,
        [(one.moving, one.fixed, one.offset, one.failure, one.apart) for one in found.pairs],
    )


def tables(times=None, g=None, dark=Z1[0], bright=Z1[2]):
    """Return two photographs as light."""
    return alignment.light_scale(Z1, times, g)(0, 2, dark, bright)


def judged(k, photographs=PHOTOGRAPHS):
    """Return what is found of a pair."""
    moving, B, fixed, A = photographs[k]
    return alignment.best_percentile(moving, B, fixed, A)


def lit(images):
    """Return what is found of pairs by their light."""
    as_light = alignment.light_scale(images, TIMES[: len(images)], G)
    return list(alignment.register_by_light(images, as_light, "cerman"))


def counted(images, times, *, valid):
    """Return a curve that tells what it is recovered from."""
    return np.array([images.shape[2], images.sum(), valid.sum(), images[:, valid[0]].sum()])


def aligned(taken, *args, **named):
    """Return a bracket aligned: its photographs, places, notes and doubts."""
    found = registration.aligned(taken, *args, **named)
    return found.bracket, found.offsets, found.homographies, found.notes, found.doubts


def described(*pairs):
    """Return what is said of pairs."""
    return registration.describe(tuple(SURE._replace(**one) for one in pairs), "abcdef", "advice")


def assembled(taken, **named):
    """Return what each stage makes of a bracket."""
    return [
        (
            one.stage,
            one.bracket.times,
            one.offsets,
            one.g,
            one.E,
            one.quality,
            one.medians,
            one.notes,
            one.doubts,
            one.moving,
            one.fallback,
        )
        for one in stages.assemble_steps(taken, **{"response": "debevec", "align": "none", **named})
    ]


def corrected(taken, **named):
    """Return what the stages make of a bracket whose times are wrong."""
    return assembled(taken, **named)


def cleaned(taken, **named):
    """Return what the stages make of a bracket in which something moved or scattered light."""
    return assembled(taken, **named)


def chosen(response, taken):
    """Return the spread of a response and what is said, and the response itself."""
    found = recovery.choose_response(response, taken)
    return found.spread, found.notes, recovery.find_response(response, found, taken)


def assessed(spread=0.0, stops=(0, 0, 0), moved=0.0, bands=0.0):
    """Return what is said of a map."""
    medians = np.zeros((3, 1, 256)) + spread * np.array([0, 1, 2])[:, None, None]
    found = contradictions.Contradictions(
        np.array(stops, float), np.zeros(2), np.zeros(2), np.zeros(2), 0.0
    )
    state = stages.assess(STATE, medians * (1 if spread is not None else NAN), found, moved, bands)
    return state.notes, state.doubts, state.fallback, state.stage


def refined(taken, response="debevec", before=INF):
    """Return a bracket with other times, and what is said of them."""
    state = STATE._replace(
        bracket=taken,
        offsets=np.zeros((len(taken.times), 2), int),
        homographies=np.stack([np.eye(3)] * len(taken.times)),
    )
    found = timing.refine_times(state, response, before)
    return found.bracket.times, found.bracket.names, found.notes, found.doubts


def calibrated(*args, **changed):
    """Return a map in the unit of a reading."""
    found = stages.calibrate(STATE._replace(**changed), *args)
    return found.E, found.s, found.notes


def sure(**changed):
    """Return a map with the deviation of its values."""
    found = certainty.measure_deviation(STATE._replace(**changed))
    return found.E, found.s, found.notes


def lazy():
    """Return names that are imported when they are asked for."""
    found = [getattr(pipeline, name) for own in pipeline.PLACES.values() for name in own]
    return [getattr(one, "__module__", one) for one in found]


for home, own in {
    "alignment": (registered, tables, judged, lit),
    "registration": (aligned, described),
    "recovery": (chosen,),
    "stages": (assembled, corrected, cleaned, assessed, calibrated),
    "timing": (refined,),
    "certainty": (sure,),
    "catalogue": (lazy,),
}.items():
    for one in own:
        one.__module__ = f"hdrlab.pipeline.{home}"
TOLERANCE = 1e-4
CASES = recorded.named(
    *(of(registered, SHIFTED, *m, **k) for m, k in (((), {}), (("mtb",), {}), (("auto",), {"times": TIMES}),
        (("other",), {}))),
    *(of(registered, z, "auto") for z in (COLOUR, Z1[:1], Z1 * 0, shots(SCENE[:, ::-1], moves=((6, 6), (6,
        6), (6, 6))))),
    *(of(tables, *a) for a in ((), (TIMES,), (TIMES, G), (None, G), (None, lambda: None), (TIMES,
        lambda: np.stack([G, G * 0.9, G], axis=-1)))),
    of(tables, dark=DUSK, bright=np.where(DUSK > 8, 2 * DUSK, 8 + GRAIN // 2 % 23).astype(np.uint8)),
    *(of(judged, k) for k in (0, 1)),
    *(of(judged, 0, list(alignment.photograph_pairs(z, bits=b))) for z, b in ((np.stack([CHESS // 2,
        CHESS]), 2), (STEPPED, 1))),
    of(lit, COLOUR[:2, 20:53, 30:66] // np.uint8([2, 1, 4])),
    *(of(assembly.take_frames, STATE, np.array(o)) for o in ([0, 1, 2], [2, 0], [1, 0, 2])),
    *(of(catalogue.names, c) for c in catalogue.VERBS),
    of(lazy),
    *(of(sure, **k) for k in ({}, {"moving": (BLOCKS > 0.3).astype(np.int32)},
        {"E": BLOCKS.astype(np.float32) * 0 + 1})),
    *(of(recovery.split_stripes, t) for t in (TAKEN, TAKEN3, bracket(np.tile(Z1, (1, 3, 2)), TIMES),
        bracket(np.tile(Z1[:1], (1, 5, 4)), TIMES[:1]))),
    *(of(recovery.find_widest_gap, z) for z in ([[9, 12], [11, 30]], [[20, 60], [30, 90], [10, 251]], [[0,
        255]], [[20, 255], [0, 40]], [[10, 250]], [[50, 51]])),
    *(of(chosen, r, t) for r, t in (("linear", LINEAR), ("auto", LINEAR), ("debevec", TAKEN), ("auto",
        TAKEN3), ("robertson", TAKEN), ("mitsunaga", TAKEN), ("auto", bracket(Z1 * 0 + 9, TIMES)))),
    *(of(recovery.share_curve(space.recover), z, TIMES, **k) for z, k in ((Z3, {}), (Z1, {"valid": VALID}))),
    of(recovery.share_curve(counted), Z3, TIMES, valid=VALID),
    *(of(recovery.measure_spread, m, *recovery.split_stripes(TAKEN)) for m in (lambda *a, **k: G,
        space.recover)),
    *(of(aligned, t, a) for t, a in ((TAKEN, "none"), (bracket(SHIFTED, TIMES), "mtb"), (bracket(SHIFTED,
        TIMES), mtb.align), (bracket(SHIFTED, TIMES), "auto"))),
    *(of(aligned, bracket(SHIFTED.copy(), TIMES, valid=SHIFTED >= 0), a, "linear", in_place=i)
        for a in (mtb.align, lambda z: np.stack([np.eye(3), warp.turn(z.shape[1:], 1.0), np.eye(3)]))
        for i in (True, False)),
    *(of(described, *p) for p in ((), ({},), ({"apart": True, "failure": "f"}, {"apart": True, "moving": 3}),
        ({"apart": True}, {"apart": True}, {"apart": True}), ({"confidence": 0.2},), ({"confidence": 0.2},
        {"H": TILT}))),
    *(of(registration.provisional, t, r) for t, r in ((TAKEN, "auto"), (LINEAR, "auto"), (TAKEN, "linear"),
        (TAKEN, lambda *a, **k: G + 1), (SAME, "auto"))),
    of(registration.moved, TAKEN, np.array([[0, 0], [1, 2], [-1, 0]])),
    *(of(assembled, t, **k) for t, k in ((TAKEN, {}), (LINEAR, {"response": "auto", "weight": "snr"}))),
    of(assembled, TAKEN3, weight="hat", method="mean", times="stated"),
    *(of(corrected, t, **k) for t, k in ((FOUR, {"times": "estimate"}), (WRONG, {}), (SAME, {}))),
    *(of(cleaned, TAKEN3, **k) for k in ({"ghosts": "reference", "weight": "flat"}, {"ghosts": "regions"})),
    of(cleaned, LINEAR, flare="glare", response="auto"),
    *(of(assembled, TAKEN, **{k: "other"}) for k in ("weight", "method", "times", "ghosts", "flare")),
    *(of(calibrated, *a, **k) for a, k in (((20, 30, 100.0), {"quality": (BLOCKS > 99).astype(np.uint8),
        "s": np.ones((112, 140), np.float32)}), ((20, 30, 3.0), {"quality": np.ones((112, 140), np.uint8)}),
        ((20, 30, 3.0), {"quality": (np.indices((112, 140)).sum(0) == 51).astype(np.uint8)}))),
    *(of(assessed, *a) for a in ((), (0.5,), (0.3,), (0.2,), (0.8,), (NAN,), (0, (0, NAN, 0)), (0, (0, 0, 0),
        0.02), (0, (0, 0, 0), 0.015), (0, (0, 0, 0), 0, 0.06), (0, (0, 0, 0), 0, 0.055), (0, (0, 0, 0), 0.3,
        0.3), (0, (0, 0, 0), 0.9))),
    *(of(timing.usual_response, *a) for a in ((256,), (65536,), (256, True))),
    *(of(timing.space_by_stops, t, s) for t, s in ((TAKEN, 2), (bracket(FOUR.images[::-1], [1, 2, 3, 4]), [1,
        2, 1.5]), (TAKEN, -1), (TAKEN, 0), (TAKEN, NAN))),
    *(of(timing.estimate_relative_times, t) for t in (TAKEN, TAKEN3, LINEAR, bracket(np.tile(Z1, (1, 6, 6)),
        TIMES))),
    *(of(timing.complete_times, t, way) for t in (TAKEN, SAME, TAKEN3._replace(times=TIMES[::-1]),
        bracket(Z1[:1], [1]), bracket(Z1 * 0 + Z1[:1], TIMES)) for way in ("correct", "stated", "estimate")),
    *(of(timing.complete_times, bracket(Z3[::-1], t), way) for t, way in ((TIMES, "estimate"), (TIMES,
        "correct"), (TIMES[:1].repeat(3), "correct"))),
    of(timing.complete_times, bracket(Z3[:2], TIMES[:2]), "correct"),
    *(of(timing.complete_times, bracket(shots(BLOCKS[:56, :70], t, ((0, 0),) * len(t)), np.ones(len(t))),
        "correct") for t in ([1, 1.4], [1, 1.05, 3])),
    of(timing.describe_steps, TIMES * [1, 1, 1.1]),
    *(of(refined, t, *a) for t, a in ((FOUR, ()), (WRONG, ("debevec", 0.3)), (LINEAR, ("auto", 0.6)),
        (bracket(Z1[::-1], TIMES), ("linear", 3.0)))),
    *(of(timing.correct_times, t, "debevec", b) for t in (FOUR, TAKEN) for b in (None, 0.4)),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__, TOLERANCE)
