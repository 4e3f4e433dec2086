"""What the functions of `enhance` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded
from scipy.ndimage import gaussian_filter

from hdrlab.enhance import battiato, mertens, relight, skin

RNG = np.random.default_rng(23)
NAN = np.nan
Z = np.clip(gaussian_filter(RNG.normal(90, 160, (27, 33, 3)), (1, 1, 0)), 0, 255).astype(np.uint8)
SKIN = Z.copy()
SKIN[4:12, 6:16] = np.clip([150, 108, 86] + RNG.normal(0, 5, (8, 10, 3)), 0, 255).astype(np.uint8)
GRAY = Z[..., 1]
DARK = (Z // 5).astype(np.uint8)
BLACK = np.zeros((5, 6), np.uint8)
MOSAIC = SKIN[..., 1]
Y = GRAY.astype(float)
THREE = np.stack([Z // 4, Z, np.clip(Z.astype(int) * 3, 0, 255).astype(np.uint8)])
F3, F1 = mertens.split_planes(Z), mertens.split_planes(GRAY)
LEVELS = np.array([0, 1, 64, 127.5, 200, 254])
LOCUS = RNG.integers(0, 256, (40, 30, 3))
LOCUS[:, :15] = [140, 100, 80] + RNG.integers(-12, 13, (40, 15, 3))
SAMPLES = np.array(
    [[200, 150, 130], [180, 120, 100], [120, 80, 70], [90, 66, 50], [240, 200, 190.0]]
)
SOMETHING = skin.Skin(np.array([-10.0, 20.0]), np.array([[30.0, 5], [5, 60]]))


def settled(Y, *args, **named):
    """Return the states until the mean is settled."""
    return relight.settle_steps(relight.shares(Y), *args, **named)


settled.__module__ = "hdrlab.enhance.relight"
CASES = recorded.named(
    *(of(battiato.brightness, z) for z in (Z, GRAY)),
    *(of(battiato.brighten, z, **k) for z, k in ((DARK, {}), (GRAY, {"a": 1.2, "c": 0.3}))),
    *(of(f, b) for f in (battiato.histogram, battiato.contrast, battiato.focus) for b in (Y, Y[:3, :4],
        Y * 0 + 255)),
    of(battiato.focus, Y, noise=60.0),
    *(of(battiato.split_blocks, Y, *n) for n in ((), (3,), (40,))),
    *(of(battiato.relevance, np.array([[1.0, 4], [0, 2]]), np.array([[3.0, 0], [1, 9]]), **k) for k in ({},
        {"share": 0.2})),
    of(battiato.relevance, np.zeros((1, 2)), np.zeros((1, 2))),
    *(of(battiato.find_relevant_blocks, Y, **k) for k in ({}, {"count": 3, "noise": 60.0})),
    *(of(battiato.correct, z) for z in (Z, SKIN, GRAY, DARK, BLACK, SKIN // 3, 255 - DARK)),
    *(of(battiato.correct, SKIN, **k) for k in ({"by": "skin", "target": 90}, {"by": "blocks", "noise": 5.0},
        {"shape": (1.2, 0.3)}, {"least": 9.0}, {"find_skin": skin.find_by_locus})),
    *(of(battiato.correct, GRAY, **k) for k in ({"by": "skin"}, {"by": "other"}, {"target": 0.9},
        {"target": 1}, {"target": 254}, {"target": 254.1})),
    *(of(battiato.quarter_size, z) for z in (MOSAIC, MOSAIC[:2, :2], MOSAIC[:1], MOSAIC[:, :1], Z, Y,
        np.array([[1, 2], [3, 4]], np.uint8))),
    *(of(battiato.correct_mosaic, MOSAIC, **k) for k in ({}, {"shape": (1.2, 0.3), "target": 100})),
    *(of(mertens.split_planes, z) for z in (Z, GRAY, Z.astype(np.uint16))),
    *(of(f, p) for f in (mertens.contrast, mertens.saturation, mertens.exposedness) for p in (F3, F1)),
    *(of(mertens.weight, F3, *p) for p in ((), ((0, 1, 1),), ((2, 0, 0),), ((0.5, 2, 3),))),
    *(of(mertens.weights, z, *p) for z in (THREE, THREE[..., 0]) for p in ((), ((1, 0, 2),))),
    of(mertens.add_term, F1, F1[0], F3[:1]),
    *(of(mertens.fuse_steps, z[:, :9, :8], **k) for z, k in ((THREE, {}), (THREE[..., 0], {"contrast": 0.0,
        "saturation": 2.0, "exposedness": 0.5}))),
    *(of(mertens.fuse, z, **k) for z, k in ((THREE, {}), (THREE[..., 1], {}), (THREE, {"contrast": 0.0,
        "saturation": 2.0, "exposedness": 0.5}))),
    *(of(mertens.fuse, THREE, **{k: v}) for k in ("contrast", "saturation", "exposedness") for v in (-1,
        np.inf)),
    *(of(f, LEVELS, **k) for f in (relight.f_inv, relight.f) for k in ({}, {"a": 1.1, "c": 0.4})),
    *(of(relight.offset, *a, **k) for a, k in (((90,), {}), ((90, 200), {"a": 1.1, "c": 0.4}), ((1e-9,), {}),
        ((254.999999, 1), {}))),
    *(of(f, d, **k) for f in (relight.curve, relight.table) for d in (0.0, 1.3, -2) for k in ({}, {"a": 1.1,
        "c": 0.4})),
    *(of(relight.shares, y) for y in (Y, [0.4, 0.6, 1.5, 255])),
    *(of(settled, y, *a, **k) for y, a, k in ((DARK, (), {}), (Z, (60,), {"a": 1.1, "c": 0.4}), (BLACK, (),
        {}), (BLACK + 255, (), {}), (BLACK + 128, (), {}), ([0, 0, 0, 255], (250,), {}))),
    *(of(settled, [127, 128], t) for t in (128, 127, 127.9999, 128.5)),
    *(of(f, Z) for f in (skin.chrominance, skin.distance, skin.likelihood, skin.find_by_chrominance)),
    *(of(f, LOCUS) for f in (skin.find_by_chrominance, skin.find_by_locus)),
    *(of(f, [[0, 0, 0], [1, 2, 3]]) for f in (skin.chrominance, skin.find_by_locus)),
    *(of(f, Z, SOMETHING) for f in (skin.distance, skin.likelihood, skin.find_by_chrominance)),
    *(of(skin.find_by_chrominance, Z, reach=r) for r in (1.0, 5.0)),
    *(of(skin.fit, z) for z in (SAMPLES, SAMPLES[:2], SAMPLES[:3], SAMPLES[0], SAMPLES[:, :2], SAMPLES * 0)),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__)
