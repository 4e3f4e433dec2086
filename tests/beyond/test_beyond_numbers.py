"""What the functions of `beyond` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded
from scipy.ndimage import gaussian_filter

from hdrlab.beyond import (
    assorted,
    bidirectional,
    flow,
    flutter,
    ldr_values,
    neighbours,
    patches,
    patchmatch,
    splitter,
    steady,
    synthesis,
    video,
)
from hdrlab.capture import responses
from hdrlab.core import weights
from hdrlab.core.filters import mosaic
from hdrlab.tonemap import reinhard

RNG = np.random.default_rng(31)
INF, NAN = np.inf, np.nan
E = gaussian_filter(RNG.lognormal(-1, 1.5, (22, 26, 3)), (1, 1, 0)).astype(np.float32)
L = E[..., 1]
CELLS = mosaic.tile(assorted.FOUR_EXPOSURES, (22, 26))
COLOURS, STEPS = (mosaic.tile(one, (22, 26)) for one in assorted.colours_and_exposures())
READ = assorted.shoot(L / 2, CELLS, bits=16)
READ3 = assorted.shoot(E / 2, STEPS, COLOURS)
FULL = np.full((22, 26), 255, np.uint8)
CODE = np.array([1, 0, 1, 1, 0, 0, 1])
LINE = RNG.random((12, 2))
TIMES = np.array([0.25, 1.0, 4.0])
G = responses.true_g("gamma")
X = np.clip(np.multiply.outer(TIMES, E), 0, 1)
X[1, 4:9, 3:8], X[2, 4:9, 12:17] = 0.7, 0.9
SHOTS = np.rint(255 * X ** (1 / 2.2)).astype(np.uint8)
VALUES = ldr_values.as_values(SHOTS, TIMES, G)
SCENE = patches.as_scene(SHOTS, TIMES, G, None)
V, NOISE, CUT = VALUES.v[1], VALUES.noise[1], VALUES.clipped[1]
SMALL = synthesis.resize_scene(SCENE, (11, 13))
PATCH, FAR = (
    patchmatch.cut_patches(V, 3),
    patchmatch.make_sources(VALUES.v[::2], 3, VALUES.noise[::2, ..., 0]),
)
AT = RNG.integers(0, 9, (20, 24, 3)) % [2, 20, 24]
FIELD = patchmatch.start_field(PATCH, FAR, AT)
U = gaussian_filter(RNG.normal(0, 4, (2, 22, 26)), (0, 2, 2)).astype(np.float32)
FRAMES = [video.as_frame(z, t, G, None) for z, t in zip(SHOTS, TIMES, strict=True)]
SHARES = splitter.shares()
SPLIT = splitter.shoot(L, SHARES)
SHOWN = [np.minimum(L * s, 1) for s in (0.3, 0.5, 0.4, 0.45)]
H4 = E[:4, :5].reshape(1, 4, 5, 3)


def level(f, *args, **named):
    """Return no motion but one: half a pixel to the right."""
    return np.stack([np.zeros_like(f), np.full_like(f, 0.5)])


def searched(rounds=2, radius=6, count=2):
    """Return the fields of a search."""
    steps = patchmatch.search_steps(PATCH, FAR, FIELD, radius=radius, rng=np.random.default_rng(1))
    return [field for _, field in zip(range(rounds), steps, strict=False)]


def places(*args):
    """Return places at random around others."""
    return patchmatch.random_places(*args, np.random.default_rng(2))


def both(side=3):
    """Return what is searched in both directions, what it is worth and what it votes for."""
    S, price = synthesis.boost_photographs(1, SMALL)
    w = synthesis.weigh_patches(1, SMALL, price, side)
    start = patches.start_fields((11, 13), 3, side)[1]
    found = bidirectional.search(
        SMALL.L[1], S, price, start, bidirectional.Search(side, 2, 5), np.random.default_rng(3)
    )
    return found, bidirectional.similarity(w, found), bidirectional.vote(S, w, found, side)


def measured(**named):
    """Return what a film shows."""
    return steady.tonemap_steps([E, E * 2, E * 0.7, E], reinhard.tonemap, **named)


searched.__module__ = places.__module__ = "hdrlab.beyond.patchmatch"
both.__module__, measured.__module__ = "hdrlab.beyond.bidirectional", "hdrlab.beyond.steady"
LOOSE = {
    f"beyond.{name}": 2e-5
    for name in ("patches.synthesise", "patches.synthesise_steps", "flow.tvl1")
}
CASES = recorded.named(
    *(of(assorted.colours_and_exposures, *a) for a in ((), ([0.5, 0.1],))),
    *(of(assorted.added_decades, e) for e in ([1, 0.01], assorted.FOUR_EXPOSURES)),
    *(of(assorted.shoot, e, t, *c, **k) for e, t, c, k in ((L, CELLS, (), {}), (E, STEPS, (COLOURS,),
        {"bits": 16}), (L * 9, CELLS, (), {"full_well": 300.0, "read_noise": 4.0, "rng": 2}))),
    *(of(assorted.shoot, e, t, *c, **k) for e, t, c, k in ((E, CELLS, (), {}), (L, CELLS, (COLOURS,), {}),
        (L, CELLS, (), {"bits": 9}), (L, CELLS, (), {"full_well": 0}), (L, CELLS, (), {"read_noise": -1}),
        (L, CELLS, (), {"read_noise": INF}), (L, CELLS * 0, (), {}), (L, CELLS * 2, (), {}), (L, CELLS[1:],
        (), {}))),
    *(of(assorted.weight, z, CELLS, **k) for z, k in ((READ, {}), (READ3, {"full_well": 300.0,
        "read_noise": 4.0}), (np.tile(np.array([[253, 254]], np.uint8), (22, 13)), {}))),
    *(of(assorted.normalised_convolution, L, CELLS * s, 0.7) for s in (1, 0)),
    *(of(assorted.reconstruct, z, t, *c, **k) for z, t, c, k in ((READ, CELLS, (), {}), (READ3, STEPS,
        (COLOURS,), {}), (READ, CELLS, (), {"sigma": 1.0, "full_well": 300.0, "read_noise": 4.0}), (FULL,
        CELLS, (), {}), (FULL, STEPS, (COLOURS,), {}))),
    *(of(assorted.reconstruct, z, CELLS) for z in (READ3[None], READ * 1.0, READ[:0])),
    of(assorted.reconstruct, np.where(np.indices((22, 26))[1] < 20, 255, READ3).astype(np.uint8), CELLS),
    of(both),
    *(of(flow.tvl1, a, b) for a, b in ((L, np.roll(L, 1, axis=1)), (L[:15], L[:15]))),
    *(of(flow.warp, f, U) for f in (L, E)),
    *(of(flow.lands_inside, u) for u in (U, U * 0, np.float32([[[0, -0.1]], [[1, 0]]]), np.float32([[[0.0,
        0.1]], [[-0.1, 0]]]))),
    of(flow.halve_flow, U),
    *(of(flutter.as_code, h) for h in (CODE, [0, 0], [1, 2], [[1, 0]], [1])),
    of(flutter.box, 4),
    *(of(flutter.transfer, h, *n) for h, n in ((CODE, (9,)), ([1], ()), (flutter.RASKAR_CODE, (33,)))),
    *(of(f, h) for f in (flutter.amplification, flutter.equivalent_pictures) for h in (CODE,
        flutter.RASKAR_CODE, [1, 1], [1])),
    *(of(f, x, CODE) for f, x in ((flutter.smear, LINE), (flutter.smear, LINE[:, 0]))),
    of(flutter.matrix, CODE, 4),
    *(of(flutter.sharpen, y, CODE) for y in (flutter.smear(LINE, CODE), LINE[:, 0], LINE[:7], LINE[:6],
        LINE * NAN)),
    *(of(flutter.expose, LINE, CODE, **k) for k in ({}, {"gain": 3.0, "sigma": 0.05, "bits": 4, "rng": 2})),
    *(of(flutter.combine, x, g) for x, g in (([[0.2, 0.998, 0.9995, 1], [0.1, 0.4, 0.5, 1]], [2, 1]), ([0.2],
        [1]), ([[0.2]], [1, 2]), ([[0.2]], [0]))),
    *(of(ldr_values.radiance, V, 2.0, np.float32(f)) for f in (1, 3)),
    *(of(ldr_values.expose, E, 2.0, np.float32(f)) for f in (1, 3)),
    *(of(ldr_values.boost, V, r) for r in (0.5, 3.0)),
    of(ldr_values.consistent_range, V, NOISE, CUT, 2.0, np.float32(3)),
    *(of(ldr_values.resize_picture, a, s) for a in (V, CUT) for s in ((22, 26), (11, 13), (30, 35))),
    *(of(ldr_values.resize_picture, V, s) for s in ((22, 13), (24, 20))),
    of(ldr_values.look_up_levels, np.arange(12).reshape(4, 3), np.array([[[0, 1, 3], [2, 2, 2]]])),
    *(of(ldr_values.as_values, z, t, g) for z, t, g in ((SHOTS, TIMES, G), (SHOTS[..., 0], TIMES, G + 1),
        (SHOTS, [1, 2], G))),
    *(of(neighbours.slide_windows, range(n), s) for n in (0, 1, 4) for s in (0, 1, 2)),
    *(of(patches.plan_scales, s, c) for s, c in (((22, 26), 24), ((60, 90), 24), ((90, 40, 3), 10), ((30,
        31), 24))),
    *(of(patches.as_scene, z, t, G, r) for z, t, r in ((SHOTS, TIMES, None), (SHOTS, [4, 1, 0.25], 0),
        (SHOTS[..., 0], TIMES, 2), (SHOTS, TIMES, 3), (SHOTS, TIMES, -1))),
    *(of(patches.synthesise_steps, SHOTS[:, :9, :8], TIMES, G, **k) for k in ({"side": 3, "coarsest": 6,
        "rounds": (1, 1)}, {"side": 3, "rounds": (2, 0), "reference": 0, "rng": 3})),
    *(of(patches.synthesise, SHOTS[:, :12, :14, :], TIMES, G, **k) for k in ({"coarsest": 8, "rounds": (1,
        1)}, {"side": 4}, {"side": 1}, {"side": 13}, {"rounds": (-1, 0)})),
    of(patches.synthesise, SHOTS[..., 1], TIMES, G, side=3, coarsest=12, rounds=(1, 0)),
    *(of(patches.plan_rounds, *a) for a in (((8, 2), 4), ((0, 0), 1), ((-1, 2), 3), ((3, -1), 3), ((5, 0),
        3))),
    of(patches.start_fields, (6, 7), 2, 3),
    *(of(patchmatch.cut_patches, a, s) for a, s in ((V, 3), (VALUES.v, 5))),
    *(of(patchmatch.make_sources, VALUES.v, 3, *p) for p in ((), (NOISE[None, ..., 0].repeat(3, 0),))),
    *(of(patchmatch.distance, PATCH, FAR, a) for a in (AT, AT[::-1])),
    of(patchmatch.distance, np.tile(PATCH, (6, 2, 1)), FAR, np.tile(AT, (6, 2, 1))),
    *(of(patchmatch.start_field, PATCH, FAR, AT * s) for s in (1, 5, -3)),
    of(patchmatch.keep_nearer, FIELD, PATCH, FAR, AT[::-1] + 3),
    *(of(patchmatch.propagate, AT, s) for s in patchmatch.NEIGHBOURS),
    *(of(places, AT, r, n) for r, n in ((3, 1), (5, 2))),
    *(of(searched, *a) for a in ((), (1, 0), (1, 1))),
    *(of(patchmatch.identity_field, 2, 3, *s) for s in ((), (4,))),
    *(of(patchmatch.upscale_field, AT[:6, :7], s) for s in ((9, 10), (12, 14))),
    of(patchmatch.sum_votes, VALUES.v[::2], FIELD.at, (22, 26), 3),
    of(patchmatch.sum_given_votes, VALUES.v[0], FIELD.at, L[:20, :24], (22, 26), 3),
    *(of(splitter.shares, *a) for a in ((), ((0.3, 0.2),))),
    *(of(splitter.shoot, e, SHARES, *c, **k) for e, c, k in ((L, (), {}), (E, (COLOURS,), {"bits": 16}), (L,
        (), {"full_well": 500.0, "read_noise": 3.0, "rng": 3}), (L, (), {"bits": 8}), (L, (), {"bits": 7}),
        (L, (), {"bits": 17}))),
    of(splitter.full_share, READ > 9000),
    of(splitter.predict_full, L, L[::-1] * (READ > 3000), READ > 9000),
    of(splitter.predict_full, L, L[::-1], READ >= 0),
    of(splitter.join_sensors, L.astype(float), L[::-1].astype(float), READ > 5000),
    *(of(splitter.merge_steps, SPLIT, SHARES, **k) for k in ({}, {"full": 0.3}, {"full": 0}, {"full": 1},
        {"full": 1.1})),
    *(of(splitter.merge_steps, z, SHARES) for z in (SPLIT[0], SPLIT * 1.0, SPLIT[:2],
        SPLIT.astype(np.uint8))),
    *(of(splitter.merge, SPLIT, SHARES, *c, **k) for c, k in (((), {}), ((COLOURS,), {"full": 0.5}))),
    *(of(splitter.as_shares, e) for e in (SHARES, [0.5, 0.5], [0.5, 0], [], [[0.5]], [0.9, 0.102], [0.9,
        0.1009], 0.5)),
    *(of(steady.measure_frame, e, **k) for e, k in ((E, {}), (L * (L > 0.3), {"delta": 0.1}), (L * 0, {}))),
    of(steady.adapt, [steady.FrameStatistics(L, L, m, h) for m, h in ((0.1, 3.0), (-0.5, 9.0), (0.3, 0.0))],
        key=0.4),
    *(of(measured, **k) for k in ({}, {"key": 0.5, "span": 2}, {"span": 0}, {"span": -1}, {"key": 0},
        {"key": INF})),
    *(of(steady.flicker, *a) for a in ((SHOWN,), (SHOWN, L > 0.5), (SHOWN[:2],), (SHOWN[:3],))),
    *(of(synthesis.trapezoid, VALUES.z[1], *r) for r in (patches.TRUSTED_LEVELS, video.EXPOSED_LEVELS)),
    of(synthesis.trapezoid, np.linspace(0, 1, 60).reshape(5, 12, 1), *patches.TRUSTED_LEVELS),
    of(synthesis.trust_weights, VALUES.v[::-1]),
    *(of(f, VALUES.v) for f in (synthesis.triangle, synthesis.trust_weights)),
    *(of(f, VALUES.v, SCENE) for f in (synthesis.merge_exposures,)),
    *(of(f, E * s, SCENE) for f in (synthesis.blend_reference, synthesis.extract_exposures) for s in (1,
        0.8)),
    *(of(synthesis.guess_radiance, SCENE._replace(reference=k)) for k in (0, 1, 2)),
    *(of(synthesis.boost_photographs, k, SCENE) for k in (0, 1, 2)),
    *(of(synthesis.weigh_patches, k, SCENE, synthesis.boost_photographs(k, SCENE)[1], 3) for k in (0, 1, 2)),
    *(of(synthesis.resize_scene, SCENE, s) for s in ((11, 13), (30, 30))),
    *(of(video.estimate_motion, FRAMES[j], FRAMES[k], lambda a, b: np.stack([a, b])) for j, k in ((0, 1), (2,
        1))),
    *(of(video.warp_frame, FRAMES[1], u) for u in (U, U * 0 + 0.5)),
    of(video.consistency, V, np.float32(0.97) * V),
    of(video.weigh_neighbour, FRAMES[1], video.Term(FRAMES[0].R, FRAMES[0].w)),
    of(video.warp_half_way, FRAMES[0], FRAMES[2], level),
    of(video.clip_to_frame, FRAMES[1], E * np.float32(0.98)),
    of(video.blend_terms, FRAMES[1], [video.Term(FRAMES[0].R, FRAMES[0].w)], [video.Term(FRAMES[2].R,
        FRAMES[2].w)]),
    of(video.blend_terms, FRAMES[1]._replace(w=FRAMES[1].w * 0), [], []),
    *(of(video.merge_steps, z, t, G, *w, flow=level) for z, t, w in ((SHOTS, TIMES, ()), (SHOTS[[0, 1, 0, 1],
        ..., 1], [0.25, 1], (weights.hat(),)))),
    *(of(video.merge, z, t, G, flow=level) for z, t in ((SHOTS, TIMES), (SHOTS[:1], 0.5), ([], 1), (SHOTS,
        [0, 1]), ([SHOTS[0], SHOTS[1, 1:]], [1, 2]), (SHOTS[:2, ..., 0], [1, 4]))),
    of(video.merge, SHOTS, TIMES, G),
    of(video.as_frame, SHOTS[1], 0.5, G, weights.hat()),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__, LOOSE.get(function, recorded.TOLERANCE))
