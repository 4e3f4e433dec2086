"""What the functions of `fast` answer to some input, written down; sizes lie on either side of a band."""

from functools import partial as of

import numpy as np
import pytest
import recorded
from scipy.ndimage import gaussian_filter

from hdrlab import fast
from hdrlab.align import mtb as lesson
from hdrlab.capture import responses
from hdrlab.core import sampling, weights
from hdrlab.fast import (
    _bands,
    _lookup,
    bilateral,
    blur,
    brush,
    chiu,
    curves,
    debevec,
    durand,
    fattal,
    local_laplacian,
    merge,
    mertens,
    mtb,
    pyramid,
    reinhard,
    robertson,
    ward,
)
from hdrlab.response import robertson as plain
from hdrlab.tonemap import ward as adjustment

RNG = np.random.default_rng(37)
INF, NAN = np.inf, np.nan
L = gaussian_filter(RNG.lognormal(0, 2.5, (70, 41)), 1.0).astype(np.float32)
SMALL = L[:26, :31]
lL, LN = np.log10(SMALL), np.log(L)
PHI = RNG.uniform(0.2, 2, L.shape).astype(np.float32)
LARGE = RNG.random((140, 131)).astype(np.float32)
TALL = RNG.random((3, 41, 900)).astype(np.float32)
TIMES = np.array([0.25, 1.0, 4.0])
LIGHT = gaussian_filter(RNG.lognormal(-1.5, 1.5, (50, 38, 3)), (1, 1, 0))
Z3 = np.rint(255 * np.clip(np.multiply.outer(TIMES, LIGHT), 0, 1) ** (1 / 2.2)).astype(np.uint8)
Z3[:, 2, 3], Z3[:, 4, 4, 0], Z3[:, 5, 5], Z3[0, 6, 6], Z3[1:, 6, 6], Z3[:, 7, 7, 1:] = (
    255,
    255,
    0,
    0,
    255,
    0,
)
Z1 = Z3[..., 1].copy()
DEEP = Z1.astype(np.uint16) * 257
FIVE = np.concatenate([Z3, Z3[:2, ::-1]])
G = responses.true_g("gamma")
RGBG = np.stack([G, responses.true_g("film"), G + 0.2], axis=-1)
VALID = RNG.random(Z1.shape) > 0.2
GRAY = RNG.integers(0, 256, (70, 150), np.uint8)
MOVED = np.roll(GRAY, (3, -5), axis=(0, 1))
WIDE = gaussian_filter(RNG.normal(120, 900, (3, 80, 170)), (0, 3, 3)).clip(0, 255).astype(np.uint8)
WIDE[1], WIDE[2] = (
    np.roll(WIDE[0], (2, -3), axis=(0, 1)),
    np.roll(WIDE[0] // 2, (-4, 9), axis=(0, 1)),
)
SIXTY = RNG.integers(0, 256, (600, 900), np.uint8)
HUGE = np.tile(SIXTY, (2, 1))
WORDS = RNG.integers(0, 2**63, (2, 3, 4)).astype(np.uint64)
Z, BELL = sampling.by_grid(Z1, 60), weights.cut(weights.gaussian(), below=0.02)
MANY = np.tile(Z, (600, 1))
MEANS = plain.linear() * np.exp(RNG.normal(0, 0.05, 256))
MEANS[[0, 30, 31, 200]] = NAN
AXES = bilateral._axes(lL, sigma_s=3.0, sigma_r=0.3)


def histograms():
    """Return the histograms of each row of the grid, and what a value is worth at each node."""
    return [*bilateral._histograms(lL, AXES)], bilateral._closeness(AXES)


def words(value):
    """Return words as halves, which a float holds to the last bit."""
    return value.view(np.uint32)


def compared(offset, level=0, q=0.5, image=GRAY, other=MOVED, **named):
    """Return how two photographs differ after a shift."""
    A, B = (mtb.Photograph(one, **named) for one in (image, other))
    differ, kept, n = B.compare(A, offset, level, q)
    counts = B.count_differences(A, offset, level, q)
    return words(differ), words(kept), n, counts, B.error(A, level, q, offset), B.offset_onto(A, q)


def photograph(image, **named):
    """Return the levels of a photograph, their histograms and thresholds."""
    found = mtb.Photograph(image, **named)
    return (
        found.Y,
        found.h,
        found.overview,
        [found.threshold(q, k) for q in (0.2, 0.5) for k in range(len(found.Y))],
    )


def bitmaps(Y, t):
    """Return the bitmaps of a photograph."""
    return words(mtb._bitmaps(Y, t))


def slid(by):
    """Return words moved."""
    return words(mtb._slide(WORDS, by))


def banded(n, margin, channels=()):
    """Return a band's work, joined."""
    picture = np.arange(n * 3.0).reshape(*channels, n, 3)
    return _bands.banded(lambda a: a.reshape(-1, 3) * len(a.reshape(-1, 3)), picture, margin=margin)


def interpolated(knots, at):
    """Return a table, and what is read from it."""
    table = _lookup.tabulate(knots)
    return table, _lookup.interpolate(table, at)


def joint(Z=Z, w=BELL):
    """Return the matrix of all pairs of levels, how often each is seen, and what it makes of a curve."""
    found = robertson.Joint(Z, TIMES, w)
    return found.S, found.pixels, found(plain.linear())


def smooth(smoothness, **named):
    """Return the states of smooth iterations."""
    return robertson.Smooth(smoothness)(Z, TIMES, BELL, **named)


HOMES = {
    "bilateral": (histograms,),
    "mtb": (compared, photograph, bitmaps, slid),
    "_bands": (banded,),
    "_lookup": (interpolated,),
    "robertson": (joint, smooth),
}
for home, own in HOMES.items():
    for one in own:
        one.__module__ = f"hdrlab.fast.{home}"
TOLERANCE = 1e-5  # products of single precision
CASES = recorded.named(
    *(of(bilateral._axes, v, sigma_s=s, sigma_r=r) for v, s, r in ((lL, 3.0, 0.3), (lL, 6.5, 0.02), (lL * 0,
        1.0, 0.4), (lL * 500, 2.0, 0.4), (lL[:1], 4.0, 1.0), (lL[:, :9], 8.0, 0.1))),
    of(histograms),
    *(of(bilateral.bilateral, v, sigma_s=s, sigma_r=r) for v, s, r in ((lL, 3.0, 0.3), (lL, 6.5, 1.0),
        (lL[:1], 2.0, 0.4), (lL * 0, 1.0, 0.4), (lL.T, 1.5, 0.05), (lL[:, :3], 9.0, 0.5))),
    *(of(bilateral.bilateral, lL * s, sigma_s=t, sigma_r=0.4) for s, t in ((500, 2.0), (1, 0), (NAN, 1))),
    *(of(blur.gaussian, a, s) for a in (SMALL, L, L[:1], L[:, :2], LARGE) for s in (0.3, 2.5, 3.99, 4, 7.9,
        8, 17)),
    *(of(blur.gaussian, a, s) for a, s in ((L, 0), (L, INF), (L[0], 1), (L[:0], 1))),
    *(of(blur._taps, s, **k) for s, k in ((0.4, {}), (1.125, {}), (2.0, {"reach": 5}))),
    *(of(blur._band, k, *n) for k, n in (([1, 2, 3], (2,)), ([1, 2, 1], (3, 2)))),
    *(of(blur._spline, h, n) for h, n in ((2, 3), (4, 1))),
    *(of(blur._pad, L[:n, :n], 2) for n in (15, 16, 17)),
    *(of(brush.tonemap, L, **k) for k in ({}, {"bins": 7, "limit": 1.2}, {"bins": 0})),
    *(of(f, L) for f in (chiu.tonemap, curves.tonemap, durand.tonemap, fattal.tonemap,
        local_laplacian.tonemap, reinhard.tonemap, ward.tonemap)),
    of(chiu.smooth, PHI, L),
    *(of(debevec.gsolve, z, np.log(TIMES), s, BELL) for z, s in ((Z, 3.0), (Z, 30.0), (Z * 0 + 255, 3.0), (Z,
        0))),
    of(debevec.gsolve, np.array([[0, 1, 2], [2, 5, 6]]), np.log(TIMES), 3.0, weights.hat(8)),
    of(debevec.gsolve, np.array([[0, 1, 2], [2, 5, 6], [0, 0, 7]]), np.log(TIMES), 0.5, weights.hat(8)),
    *(of(debevec.gsolve, z, b, s, w) for z, b, s, w in ((Z, np.log(TIMES), -1, BELL), (Z, np.log(TIMES), INF,
        BELL), (Z[0], np.log(TIMES), 1, BELL), (Z * 1.0, np.log(TIMES), 1, BELL), (Z[:0], np.log(TIMES), 1,
        BELL), (Z, np.log(TIMES), 1, -BELL), (Z, np.log(TIMES), 1, BELL[:, None]), (Z, np.log(TIMES), 1,
        BELL[:99]), (Z - 99, np.log(TIMES), 1, BELL), (Z, TIMES[:2], 1, BELL), (Z, TIMES * NAN, 1, BELL))),
    *(of(debevec.recover, z, TIMES, samples=60) for z in (Z3, Z1)),
    of(debevec._stiffness, weights.hat(6), 3.0),
    of(durand.combine, lL, lL[::-1] * np.float32(0.1)),
    of(durand.fix_uncertain, lL, PHI[:26, :31] * 3, sigma_s=2.0),
    of(fattal.divergence, LN, PHI),
    *(of(fattal.attenuation_steps, s, **k) for s, k in ((LN, {}), (np.log(LARGE + 0.1), {"alpha": 0.3,
        "beta": 0.8, "noise": 0.5}))),
    *(of(local_laplacian.remap, LN, 0.4, sigma=0.7, alpha=a, beta=b) for a, b in ((1, 0), (1, 0.3), (0.7,
        0.2))),
    *(of(local_laplacian.filtered, LN, sigma=0.5, alpha=a, beta=0.1, samples=5) for a in (1, 1.2)),
    *(of(merge.merge, z, TIMES, g) for z, g in ((Z3, RGBG), (Z1, G), (DEEP, G))),
    *(of(merge.merge_with_quality, z, TIMES, g, method=m) for z, g in ((Z3, RGBG), (Z1, G))
        for m in merge.TERMS),
    *(of(merge.merge_with_quality, Z3, t, RGBG, **k) for t, k in ((TIMES[::-1], {}), (TIMES, {"top": 0.5}),
        (TIMES, {"repair": False}), (TIMES, {"valid": VALID}), ([1, 1, 1], {}))),
    *(of(merge.merge_with_quality, z, t, G, weights.gaussian()) for z, t in ((FIVE, [1, 2, 4, 0.5, 8]),
        (FIVE[:4], [1, 2, 4, 0.5]), (DEEP[:1], [2.0]), (Z1[:2], [1, 3]))),
    of(merge.merge_with_quality, DEEP, TIMES, G, valid=VALID, method="shot"),
    *(of(mertens.weights, Z3, *p) for p in ((), ((0.5, 0, 2),))),
    of(mertens.add_term, TALL, L[:41, :1] * TALL[0], TALL[::-1]),
    *(of(mertens.fuse, z, **k) for z, k in ((Z3, {}), (Z1, {"contrast": 0.5, "exposedness": 2.0}))),
    *(of(photograph, a, **k) for a, k in ((GRAY, {}), (GRAY, {"bits": 2}), (Z3[1], {"luma": True}), (HUGE,
        {"bits": 3}), (DEEP[1], {"bits": 1}))),
    *(of(photograph, GRAY[:n, :40], bits=3) for n in (15, 16, 31, 33)),
    *(of(compared, o) for o in ((0, 0), (2, -3), (-1, 64), (7, 130), (-69, 1), (70, 0), (1, -149))),
    *(of(compared, o, 1, 0.3) for o in ((0, 0), (2, -3))),
    *(of(compared, o, image=HUGE, other=HUGE[::-1], bits=1) for o in ((0, 0), (5, -70), (-4, 3))),
    *(of(mtb._gray, z, luma) for z in (GRAY, Z3[1], np.stack([DEEP[0]] * 3, axis=-1)) for luma in (False,
        True) if z.ndim == 3 or not luma),
    *(of(mtb._shrink, a) for a in (GRAY, GRAY[:67, :33])),
    *(of(mtb._every, a) for a in (GRAY, HUGE, SIXTY, SIXTY[:512, :512])),
    *(of(mtb._histogram, a) for a in (GRAY, HUGE, SIXTY)),
    *(of(bitmaps, a, 120) for a in (GRAY, HUGE[:, :500])),
    *(of(slid, n) for n in (0, 1, -1, 63, 64, -64, 65, -65, 130, 256, -300)),
    *(of(mtb.align, z, **k) for z, k in ((WIDE, {}), (WIDE, {"bits": 2}), (Z3, {"luma": True}), (WIDE,
        {"bits": 0}), (WIDE, {"bits": 1}))),
    *(of(banded, n, m) for n in (1, 31, 32, 33, 70) for m in (0, 2)),
    *(of(interpolated, k, a) for k, a in (([0, 1, 4, 9], [-1, 0, 0.5, 2.9, 3, 5]), ([2, 5], [0.25]))),
    *(of(pyramid.reduce, a) for a in (L, TALL, L[:3, :3], LARGE)),
    *(of(pyramid.interpolate, L[:36, :21], s) for s in ((71, 41), (72, 42))),
    *(of(f, a, 3) for f in (pyramid.gaussian, pyramid.laplacian) for a in (L, TALL)),
    *(of(pyramid.collapse, p) for p in ([L, L[:35, :21], L[:18, :11]], [TALL, TALL[:, :21, :450]])),
    of(pyramid._bands, np.zeros((2, 40, 3000))),
    of(pyramid._double, L[:5], 1 / 8),
    *(of(reinhard.log_average, a, **k) for a, k in ((L, {}), (L * (L > 1), {"delta": 0.1}), (L * 0, {}))),
    of(reinhard.scale_to_key, L, key=0.4),
    *(of(reinhard.white_point, a) for a in (L, L / 1e9)),
    *(of(reinhard.local_adaptation, a, **k) for a, k in ((L, {}), (LARGE, {"key": 0.5, "phi": 4.0,
        "threshold": 0.2}))),
    *(of(reinhard.tonemap, L, **k) for k in ({"local": True}, {"key": "auto"}, {"white": 2.0})),
    *(of(joint, *a) for a in ((), (MANY,), (Z, weights.flat()))),
    *(of(smooth, s, **k) for s, k in ((100, {"max_iterations": 4}), (3.0, {"tolerance": 0.05}))),
    *(of(robertson.Smooth, s) for s in (-1, INF)),
    of(robertson._smoother, MEANS, BELL, 10.0),
    *(of(robertson._thinned, z, 90, **k) for z, k in ((Z3, {}), (Z1, {"valid": VALID}), (np.stack([HUGE,
        HUGE // 2]), {}))),
    *(of(robertson.recover, z, TIMES, **k) for z, k in ((Z3, {"samples": 60}), (Z1, {"w": BELL,
        "valid": VALID, "samples": 90}))),
    *(of(robertson.recover, Z1, t) for t in ([1, 2], [0, 1, 2])),
    *(of(ward.display, L, *adjustment.curve(L, bins=n), black=1.0, white=100.0) for n in (7, 100)),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__, TOLERANCE)


def test_a_part_that_the_lesson_does_not_name_is_refused():
    with pytest.raises(ValueError, match="other"):
        fast.with_parts("here", lesson.shrink, other=1)
