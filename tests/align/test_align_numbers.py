"""What the functions of `align` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded
from scipy.ndimage import gaussian_filter

from hdrlab.align import cerman, homography, light, mtb, resample, shift
from hdrlab.capture import responses
from hdrlab.core.filters import warp

RNG = np.random.default_rng(7)
SCENE = gaussian_filter(RNG.lognormal(0, 1.5, (90, 110)), 2)
TIMES = np.array([0.25, 1.0])
G = responses.true_g("gamma")
FILM = responses.true_g("film")
RGBG = np.stack([G, FILM, G * 0.9], axis=-1)


def shots(scene=SCENE, times=TIMES, moves=((3, 2), (0, 0)), size=(70, 80)):
    """Return photographs of a scene, each from another place."""
    views = [scene[8 + y : 8 + y + size[0], 9 + x : 9 + x + size[1]] for y, x in moves]
    X = [np.clip(v * t / 3, 0, 1) ** (1 / 2.2) for v, t in zip(views, times, strict=True)]
    return np.rint(np.array(X) * 255).astype(np.uint8)


Z = shots()
SMALL = shots(size=(33, 36), moves=((1, -1), (0, 0)))
FOUR = shots(times=(1, 0.25, 4, 16), moves=((0, 0), (4, 1), (-3, 2), (1, -2)))
COLOUR = np.stack([FOUR, FOUR[..., ::-1], FOUR // 2], axis=-1)
DEEP = FOUR.astype(np.uint16) * 257 + 3
GRAY = RNG.integers(0, 256, (16, 18), np.uint8)
H256 = np.bincount(np.clip(RNG.normal(120, 40, 3000), 0, 255).astype(int), minlength=256)
DARK256 = np.bincount(np.clip(RNG.gamma(1.2, 9, 3000), 0, 255).astype(int), minlength=256)
MASKS = RNG.random((2, 2, 12, 14)) > 0.4
X2 = np.stack([SCENE[:40, :50], SCENE[1:41, :50] * 1.1]).astype(np.float32)
X2[0, :5, :5], X2[1, 30, 40] = np.nan, np.nan
LATTICE = light.lattice((40, 50))
SMALL_TURN = warp.turn((40, 50), 1.0, (0.6, -0.3))
POINTS = RNG.random((2, 30, 2)) * 40
POINTS[1] = warp.apply(SMALL_TURN, POINTS[0])
POINTS[1, :6] += RNG.normal(0, 9, (6, 2))
RGB = RNG.integers(0, 256, (3, 20, 24, 3), np.uint8)
VALID = RNG.random((3, 20, 24)) > 0.05
TURNS = np.stack(
    [np.eye(3), warp.turn((20, 24), 2, (0.5, 0.7)), warp.turn((20, 24), -1, (-1, 1.5))]
)
WHOLE = [[0, 0], [2, -1], [-1, 3]]
NAN = np.nan


def correlated(*args):
    """Return the places of the peaks, and how high they are."""
    c = cerman.correlation(*args)
    return cerman.peaks(c, 2), c.max(), c.shape, c[::7, ::7]


def searched(pyramid):
    """Return how a pair is searched for from the coarsest size on: where each path begins and ends."""
    return [(s.level, s.path[0], s.path[-1], s.errors[-1], s.H) for s in cerman.search(pyramid)]


def found_points():
    """Return how many points of interest agree, and where the first lie."""
    points = homography.match_points(light.pyramid(X3, X3 > 0)[0])
    return points.shape, np.round(points[:, :4], 1)


X3 = np.stack([SCENE[8:78, 9:89], SCENE[10:80, 8:88]]).astype(np.float32)
correlated.__module__ = searched.__module__ = "hdrlab.align.cerman"
found_points.__module__ = "hdrlab.align.homography"
FINE = gaussian_filter(np.random.default_rng(57).lognormal(0, 1, (22, 26)), 1.2).astype(np.float32)
RIVALS = np.stack([FINE[:16, :18], FINE[3:19, 4:22] * np.float32(1.1)])
DISPLACED = cerman.correlation(light.pyramid(X3, X3 > 0)[-1])
ROUGH = warp.as_homographies([[1.4, 0.8]])[0]
LOOSE = {f"align.cerman.{name}": 1e-4 for name in ("descend", "align", "searched")}
LOOSE["align.homography.refine"] = 1e-3

CASES = recorded.named(
    of(correlated, X2),
    of(correlated, X3),
    *(of(cerman.peaks, DISPLACED, n) for n in (1, 3, 50)),
    *(of(cerman.rigid, s, u) for s, u in (((20, 30), (1, 2, 0)), ((20, 31), (0.5, -1, 3)))),
    of(cerman.descend, X2, (0.0, 0.0, 0.0), 2.0, 0.3),
    of(cerman.descend, X2, (-1.0, 0.3, 0.1), 1.0),
    of(cerman.align, SMALL, TIMES, G),
    *(of(cerman.peaks, 0.5 * np.eye(n), 50) for n in (7, 9)),
    *(of(searched, [X, X[:, ::k, ::k]]) for X, k in ((np.ones((2, 8, 8), np.float32), 2), (RIVALS, 1))),
    of(homography.detail, X2[0]),
    of(found_points),
    *(of(homography.consensus, POINTS[:, :n]) for n in (30, 10, 9, 0)),
    of(homography.refine, X2, ROUGH),
    *(of(homography.enlarge, SMALL_TURN, *t) for t in ((), (3,), (1,))),
    *(of(light.neighbours, im, t, g) for im, t, g in ((Z, TIMES, G), (FOUR, [1, 0.25, 4, 16], FILM), (COLOUR,
        [1, 0.3, 4, 9], RGBG))),
    *(of(light.neighbours, Z, t, G) for t in ([1], [0, 1], [1, np.inf], [1, NAN])),
    *(of(light.neighbours, im, TIMES, G) for im in (Z[0], Z.astype(int), Z[:, :0], COLOUR[:2, ..., :2])),
    *(of(light.neighbours, Z, TIMES, g) for g in (G[:9], G[::-1], G * 80 / np.abs(G).max(), RGBG[:, :2],
        G * 0)),
    of(light.neighbours, DEEP, [1, 0.25, 4, 16], responses.true_g("gamma", 65536)),
    of(light.pair, Z[1], Z[0], np.exp(G), np.exp(G) * 4),
    *(of(light.pyramid, a, a < 3) for a in (X3, X3[:, :64], X3[:, :63], np.kron(X3, np.ones((1, 2, 2),
        np.float32)))),
    of(light.local_mean, X2[0]),
    of(light.local_mean, X2[0] * np.float32(NAN)),
    *(of(light.lattice, s, *n) for s, n in (((5, 7), ()), ((90, 100), ()), ((20, 30), (100,)), ((200, 90),
        ()))),
    *(of(light.differences, X2, h, LATTICE) for h in (np.eye(3), SMALL_TURN)),
    of(light.differences, X2 * [[[0]], [[1]]], np.eye(3), LATTICE),
    *(of(light.error, np.array(d)) for d in ([1.0, NAN, 3], [NAN] * 49 + [2], [NAN] * 48 + [2, 3.0], [NAN],
        [])),
    of(light.exposure_ratio, Z[0], Z[1], G),
    of(light.exposure_ratio, DEEP[1], DEEP[2], responses.true_g("gamma", 65536)),
    of(light.exposure_ratio, Z[0] * 0, Z[1], G),
    *(of(mtb.gray, a, luma=luma) for a in (COLOUR[0], FOUR[0], np.stack([DEEP[0]] * 3, axis=-1))
        for luma in (False, True) if a.ndim == 3 or not luma),
    of(mtb.gray, COLOUR[1]),
    *(of(mtb.shrink, a) for a in (GRAY, GRAY[:15, :17], np.array([[1, 2], [3, 4]], np.uint8), np.array([[0,
        1], [0, 0]], np.uint8))),
    *(of(mtb.threshold, [0, 2, 0, 4, 2], q) for q in (0, 0.25, 0.3, 0.5, 0.75, 0.76, 1)),
    of(mtb.exclusion, np.array([3, 4, 5, 8, 12, 13]), 8),
    *(of(mtb.bitmaps, GRAY, *q) for q in ((), (0.3,), (0.9,))),
    *(of(mtb.error, *MASKS, d) for d in ((0, 0), (2, -3), (-1, 4), (12, 0), (0, -14), (-40, 40))),
    of(mtb.step, *MASKS, (1, -2)),
    *(of(mtb.search, FOUR[0], FOUR[2], **k) for k in ({}, {"bits": 1}, {"bits": 2}, {"bits": 3, "q": 0.3})),
    *(of(mtb.search, GRAY[:n, :n], GRAY[:n, :n]) for n in (15, 16)),
    of(mtb.by_brightness, np.stack([GRAY[::-1], GRAY, GRAY // 2, GRAY // 2])),
    *(of(mtb.align, Z[:, : 20 + k, : 24 + k], bits=1 + k % 3) for k in range(8)),
    *(of(mtb.chain_offsets, o, s) for o, s in (([0, 1, 2], [[1, 2], [3, 5]]), ([2, 0, 3, 1], [[1, 2], [3, 5],
        [-1, 0]]), ([0], []))),
    *(of(mtb.align, FOUR, bits=b) for b in (6, 1, 0)),
    of(mtb.align, FOUR),
    *(of(mtb.align, COLOUR, luma=luma) for luma in (False, True)),
    *(of(mtb.align, a) for a in (FOUR[0], FOUR.astype(int), COLOUR[..., :2], DEEP, FOUR[:1], COLOUR)),
    *(of(mtb.percentile, *h) for h in ((H256,), (H256, DARK256), (DARK256,), (np.eye(256)[7] * 9,))),
    of(mtb.percentile, H256, near=0.2),
    *(of(mtb.divides, h) for h in (H256, DARK256, np.eye(256)[128] * 8, np.r_[np.ones(12), np.zeros(232),
        np.ones(12)])),
    *(of(resample.photographs, RGB, h, g) for h in (WHOLE, TURNS) for g in (None, RGBG, G)),
    *(of(resample.photographs, RGB[..., 0], h, g, valid=VALID) for h in (WHOLE, TURNS) for g in (None, RGBG)),
    of(resample.photographs, RGB.astype(np.uint16) * 257, TURNS, G),
    of(resample.photographs, RGB[:1, :1, :1], [[0, 0]]),
    *(of(resample.photographs, RGB, TURNS @ warp.turn((20, 24), d, (0.3, -0.2))) for d in (0.5, 7, 25)),
    of(resample.photographs, RGB[:2], TURNS),
    of(resample.photographs, np.full_like(RGB, 251), TURNS),
    *(of(shift.as_offsets, o, *n) for o, n in ((WHOLE, ()), (WHOLE, (3,)), (WHOLE, (2,)), ([[1, 2, 3]], ()),
        ([[1.0, 2]], ()), (np.empty((0, 2), int), ()))),
    *(of(shift.crop, o, (6, 7)) for o in (WHOLE, [[0, 0], [5, 0]], [[0, 0], [6, 0]], [[0, -6]], [[0, 7]],
        [[1, 1], [2, 2]], [[-1, -3]])),
    *(of(shift.shift, RGB[..., 1], o) for o in (WHOLE, [[0, 0]] * 3, [[0, 0]] * 2)),
    of(shift.shift, RGB, WHOLE),
    of(shift.shift, GRAY, [[0, 1]] * 16),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__, LOOSE.get(function, recorded.TOLERANCE))
