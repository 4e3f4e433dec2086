"""What the functions of `diagnostics.registration` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded
from scipy.ndimage import zoom

from hdrlab.align import light
from hdrlab.capture import responses
from hdrlab.core.filters import warp
from hdrlab.diagnostics import registration
from hdrlab.fast.mtb import Photograph

RNG = np.random.default_rng(43)
NAN = np.nan
G = responses.true_g("film")
SCENE = zoom(RNG.lognormal(-2, 1.4, (40, 50)), 4)[:150, :190]
SHIFTED = [np.rint(255 * responses.film(np.clip(t * SCENE, 0, 1))).astype(np.uint8) for t in (1, 4)]
MOVED = np.stack([SHIFTED[0][:140, :180], SHIFTED[1][3:143, 5:185]])
REPEATED = np.tile(MOVED[:, :28, :36], (1, 5, 5))
FLAT = np.full_like(MOVED, 90) + RNG.integers(0, 2, MOVED.shape).astype(np.uint8)
f_inv = np.exp(G)
LIGHT = light.pair(MOVED[0], MOVED[1], f_inv, f_inv / 4)[0]
REPEATS = light.pair(REPEATED[0], REPEATED[1], f_inv, f_inv / 4)[0]
TRUE = warp.as_homographies([[3, 5]])[0]
THERE = warp.as_homographies([[0, -36]])[0]
TRUE4 = warp.as_homographies([[12, 20]])[0]
APART = np.where(np.indices((2, 1, 72))[0] == np.arange(72) // 36, np.float32(1), np.float32(NAN))


def bits(images, q=0.5):
    """Return a comparison of two photographs by their bitmaps."""
    B, A = (Photograph(one, bits=4) for one in images[::-1])
    t = A.threshold(q, A.overview)
    return registration.compare_bits(
        0, 1, A.Y, A.overview, t, lambda by, k: B.count_differences(A, tuple(map(int, by)), k, q)
    )


def compared(how, images, *homographies):
    """Return how far photographs differ after each of some homographies, and which is lower where."""
    pair = how(images) if how is bits else registration.compare_light(0, 1, images)
    d = [pair.differences(H) for H in homographies]
    again = [pair.differences(H, 1) for H in homographies]
    return (
        pair.shape,
        pair.scale,
        pair.apart,
        pair.middle,
        d,
        again,
        [pair.error(one) for one in d],
        pair.lower(d[0], d[-1]),
    )


def validated(how, images, H, **named):
    """Return what is found of a homography."""
    pair = (
        how(images)
        if how is bits
        else registration.compare_light(0, 1, images, {"twice": 2, "fourfold": 4}.get(how, 1))
    )
    found = registration.validate(pair, H, **named)
    return found, found.reliable, found.known, found.step


def lowered(how, k):
    """Return where differences drawn at random are lower than others, of which few may be known."""
    rng = np.random.default_rng(k)
    if how is bits:
        pair, compared = bits(MOVED), rng.integers(0, 300, 4) * (np.arange(4) > k % 3)
        other = np.stack([compared * rng.uniform(0.05, 0.4, 4), compared], axis=-1)
        return (
            pair.lower(other * [1 - 0.06 * k, 1], other),
            pair.error(other),
            pair.error(other * 0),
        )
    pair = registration.compare_light(0, 1, LIGHT[:, :40, :50], 1 + k % 3)
    other = rng.normal(0, 0.3, 2000)
    d = other * rng.uniform(0.6 + 0.02 * k, 1.05, 2000) ** (1 + k % 2)
    known = rng.random(2000) < (0.04 if k % 2 else 0.9)
    return pair.lower(np.where(known, d, NAN), other), np.nanmean(pair.differences(TRUE))


def weighed():
    """Return which quarters of light are lower, by 20 pixels or hardly a twentieth."""
    pair = registration.compare_light(0, 1, np.ones((2, 21, 21), np.float32))
    d, other = np.full((2, 21, 21), NAN)
    d[:11, 10], d[:9, 9], d[:11, 11:], d[11:, :11] = 0.1, 0.1, np.sqrt(1 - 0.049), 0
    other[:11, 9:], other[11:, :11] = 1, 0
    return pair.lower(d.ravel(), other.ravel())


def halved():
    """Return what bitmaps compare whose overview is half as large, and which of them are lower."""
    Y = [np.zeros((64, 80), np.uint8), np.arange(1280, dtype=np.uint8).reshape(32, 40)]
    pair = registration.compare_bits(0, 1, Y, 1, 90, lambda by, k: np.array([[*by, k]]))
    d, other = np.array([[0.4755e9, 1e9], [1, 1]]), np.array([[0.5e9, 1e9], [800, 1000]])
    return (
        pair.scale,
        pair.middle,
        pair.differences(registration.shift(np.eye(3), (4, 6))),
        pair.lower(d, other),
    )


def certain():
    """Return whether a confidence of exactly as much counts."""
    return registration.uninformative(0, 1)._replace(confidence=registration.LOST).known


def refused(e, also, elsewhere, n=1):
    """Return why not to trust what errs by e, where a texture that repeats errs by so much elsewhere."""
    tile = np.tile(np.random.default_rng(3).normal(0, 1, (12, 10)).astype(np.float32), (4, 4))
    pair = registration.compare_light(0, 1, np.stack([tile, tile]), n)

    def error(by):
        return e if not by.any() else elsewhere if np.any(by % (10 * n, 12 * n)) else also

    pair = pair._replace(differences=lambda H: H[:2, 2], error=error)
    return registration.failure_reason(pair, np.eye(3), [elsewhere] * 8, True, 0)


for one in (lowered, compared, validated, weighed, halved, certain, refused):
    one.__module__ = "hdrlab.diagnostics.registration"
TOLERANCE = 1e-5
CASES = recorded.named(
    *(of(lowered, how, k) for how in ("light", bits) for k in range(14)),
    *(of(registration.rivals, np.random.default_rng(k).random((12 + k, 15))) for k in range(6)),
    *(of(registration._middle, MOVED[0][: 9 + k, : 8 + k], 8) for k in range(4)),
    *(of(compared, "light", X, np.eye(3), TRUE) for X in (LIGHT, REPEATS)),
    *(of(compared, bits, z, np.eye(3), TRUE) for z in (MOVED, REPEATED)),
    *(of(validated, how, z, h) for how, z in (("light", LIGHT), (bits, MOVED), ("light", REPEATS), (bits,
        REPEATED), ("twice", LIGHT), (bits, FLAT)) for h in (TRUE, np.eye(3), warp.as_homographies([[-20,
        30]])[0])),
    *(of(validated, how, z, warp.turn((140, 180), 2.0, (3, 5))) for how, z in (("light", LIGHT), (bits,
        MOVED))),
    *(of(validated, "light", LIGHT, TRUE, limit=n) for n in (5, 5.01)),
    of(validated, "light", LIGHT * np.float32(NAN), TRUE),
    of(validated, "light", LIGHT * np.where(np.arange(180) < 85, np.float32(1), NAN), TRUE),
    of(validated, "light", np.stack([REPEATS[0][:40, :72], REPEATS[0][:40, :72]]) * APART, THERE),
    of(validated, "fourfold", LIGHT[:, :70, :90], TRUE4),
    of(weighed),
    of(halved),
    *(of(refused, *a) for a in ((0.1, 0.16, 1.0), (0.1, 0.2, 1.0), (0.1, 0.16, 1.0, 3), (0.5, 0.6, 9.0))),
    of(certain),
    of(registration.rivals, REPEATS[0][:30, :80] * np.float32(0.01)),
    of(validated, bits, MOVED * 0, TRUE),
    of(registration.uninformative, 2, 3),
    *(of(registration.confidence, e, o) for e, o in ((0.1, [0.5, 0.7]), (0.5, [0, 0]), (0.5, [0.1]))),
    *(of(registration.rivals, m) for m in (LIGHT[0][:64, :64], REPEATS[0][:64, :64], LIGHT[0][:50, :30] * 0)),
    of(registration.shift, TRUE, (2, -7)),
    *(of(registration._middle, MOVED[0], n) for n in (64, 141, 500)),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__, TOLERANCE)
