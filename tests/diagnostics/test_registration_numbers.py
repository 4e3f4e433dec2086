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
        else registration.compare_light(0, 1, images, **({"scale": 2} if how == "twice" else {}))
    )
    found = registration.validate(pair, H, **named)
    return found, found.reliable, found.known, found.step


def lowered(how, k):
    """Return where differences drawn at random are lower than others, of which few may be known."""
    rng = np.random.default_rng(k)
    if how is bits:
        pair, compared = bits(MOVED), rng.integers(0, 300, 4) * (np.arange(4) > k % 3)
        other = np.stack([compared * rng.uniform(0.05, 0.4, 4), compared], axis=-1)
        return pair.lower(other * [1 - 0.06 * k, 1], other), pair.error(other), pair.error(other * 0)
    pair = registration.compare_light(0, 1, LIGHT[:, :40, :50], 1 + k % 3)
    other = rng.normal(0, 0.3, 2000)
    d = other * rng.uniform(0.6 + 0.02 * k, 1.05, 2000) ** (1 + k % 2)
    known = rng.random(2000) < (0.04 if k % 2 else 0.9)
    return pair.lower(np.where(known, d, NAN), other), np.nanmean(pair.differences(TRUE))


lowered.__module__ = compared.__module__ = validated.__module__ = "hdrlab.diagnostics.registration"
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
