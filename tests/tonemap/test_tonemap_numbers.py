"""What the functions of `tonemap` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded
from scipy.ndimage import gaussian_filter

from hdrlab.core.filters.bilateral import bilateral
from hdrlab.tonemap import (
    brush,
    chiu,
    curves,
    durand,
    fattal,
    local_laplacian,
    quality,
    reinhard,
    transfer,
    ward,
)

RNG = np.random.default_rng(19)
INF, NAN = np.inf, np.nan
L = gaussian_filter(RNG.lognormal(0, 2.5, (26, 31)), 0.8).astype(np.float32)
HOLES = L.copy()
HOLES[3, 4:9], HOLES[20, 30] = 0, 0
DARK, ONE, FLAT = L * 0, L[:1, :1], L * 0 + 3
TINY, ROW = L[:1, :3], L[:1]
NARROW = np.linspace(1, 1.5, 40, dtype=np.float32).reshape(5, 8)
FAR = np.float32([[1e-9, 1e-3, 1, 1e4, 1e9]])
LARGE = gaussian_filter(RNG.lognormal(0, 2, (70, 90)), 1).astype(np.float32)
lL = np.log10(L)
LN = np.log(L)
PHI = RNG.uniform(0.2, 2, L.shape).astype(np.float32)
MEAN, K = bilateral(lL, sigma_s=2.0, sigma_r=0.2)
GRAY = np.clip(255 * L / (1 + L), 0, 255).astype(np.uint8)
BIG = np.clip(255 * LARGE / (1 + LARGE), 0, 255).astype(np.uint8)
X, Y = quality.scale_luminance(LARGE), BIG.astype(float)
LM = reinhard.scale_to_key(L.astype(float))
EVEN = 1e6 + np.where(np.indices((24, 26))[1] > 13, 10.0, 0.05) * np.sin(np.arange(26.0))
STEPS = np.array([0, 1, 5, 9, 2, 0, 3, 1.0])
V = np.linspace(0, 1, 11)
SCENES = (L, HOLES, DARK, ONE, FLAT, TINY, ROW, NARROW, FAR)


def measured(L, **named):
    """Return the halo of a scale."""
    light = chiu.divide_by_median(L)
    return chiu.halo(light, chiu.scale(light, sigma=2.0), **named)


def fields(**named):
    """Return the states of a descent: what they hold and what is shown."""
    return [(*state, state.Ld) for state in chiu.tonemap_steps(chiu.divide_by_median(L), **named)]


def adapted(steps):
    """Return the scales of a picture, and the widths."""
    scales = list(reinhard.scale_steps(reinhard.blurs(LM), **steps))
    return scales[0], scales[3], scales[-1], reinhard.select_widths(scales)


measured.__module__ = fields.__module__ = "hdrlab.tonemap.chiu"
adapted.__module__ = "hdrlab.tonemap.reinhard"
CASES = recorded.named(
    *(of(brush.find_range, s) for s in SCENES),
    of(brush.bin_position, HOLES, 0.1, 9.0, 16),
    *(of(brush.histogram, brush.bin_position(L, 0.1, 9.0, n), *b) for n, b in ((16, (16,)), (1024, ()))),
    *(of(brush.clip_histogram, np.array(h) / np.sum(h), **k) for h in ([1, 2, 9, 0], [1, 1, 1, 1])
        for k in ({}, {"limit": 1}, {"limit": 1.5})),
    of(brush.cumulative, np.array([0.1, 0.6, 0.3001])),
    *(of(brush.check_knobs, *a) for a in ((1, 1), (0, 1), (1, 0.99), (0.5, 2))),
    *(of(brush.equalise, s, **k) for s in (L, HOLES) for k in ({}, {"bins": 9, "limit": 2.0}, {"bins": 0})),
    *(of(brush.place_window, (20, 30), c, s) for c in ((10, 10), (0, 29), (19.5, 3)) for s in (4, 7, 25, 99)),
    *(of(brush.lens, L, (9, 12), **k) for k in ({"size": 8}, {"size": 9, "magnification": 2}, {"size": 8,
        "bins": 16, "limit": 2.0}, {"size": 3, "magnification": 3})),
    *(of(brush.lens, L, c, **k) for c, k in (((9, 9), {"magnification": 0}), ((9, 9), {"size": 2,
        "magnification": 3}), ((1, 2, 3), {}), ((1, INF), {}), ((9, 9), {}))),
    *(of(brush.tonemap, s) for s in SCENES),
    of(brush.tonemap, L, bins=7, limit=1.2),
    *(of(chiu.choose_sigma, s, *a) for s in (L, L.T) for a in ((), (3.0,), (None,))),
    *(of(chiu.divide_by_median, s) for s in (L, DARK, FAR * 1e25)),
    *(of(chiu.scale, s, **k) for s, k in ((L, {}), (L, {"headroom": 3.0}), (L, {"sigma": 1.0}), (DARK, {}))),
    of(chiu.clamp, PHI, HOLES),
    *(of(chiu.smooth, PHI, s) for s in (L, DARK)),
    *(of(fields, **k) for k in ({}, {"passes": 0}, {"passes": 2, "headroom": 2.0, "sigma": 1.5})),
    *(of(measured, s, **k) for s, k in ((L, {"sigma": 2.0}), (HOLES, {"sigma": 1.0, "contrast": 1.0,
        "headroom": 2.0}), (L, {}))),
    *(of(chiu.tonemap, s) for s in (L, DARK, ONE)),
    *(of(chiu.tonemap, L, **k) for k in ({"headroom": 3.0, "sigma": 2.0, "passes": 3}, {"headroom": 0},
        {"sigma": 0}, {"passes": -1}, {"passes": 0})),
    *(of(curves.linear, HOLES, high=h) for h in (0.5, 9)),
    *(of(curves.gamma, HOLES, high=2.0, **k) for k in ({}, {"gamma": 1.5})),
    *(of(curves.logarithmic, HOLES, low=a, high=b) for a, b in ((0.1, 9.0), (2.0, 2.0), (3.0, 2.0))),
    *(of(curves.quantise, [0, 0.5 / 255, 0.3, 0.999, 1], levels=n) for n in (256, 2, 10, 257, 65536, 1,
        65537)),
    *(of(curves.quantise, v) for v in (V, [0, 1.1], [-0.1], [NAN])),
    *(of(curves.spread, L, s, **k) for s, k in ((PHI, {}), (PHI, {"bins": 5}), (L[::-1], {"bins": 9999}))),
    *(of(curves.tonemap, s, curve=c) for s in (L, HOLES, DARK, FLAT) for c in curves.CURVES),
    *(of(curves.tonemap, L, **k) for k in ({}, {"curve": "gamma", "gamma": 1.8, "encoded": False},
        {"cut": 0.2}, {"curve": "x"}, {"gamma": 0}, {"gamma": INF}, {"cut": -0.1}, {"cut": 0.5}, {"cut": 0})),
    *(of(durand.logarithm, s) for s in (L, HOLES, DARK, FAR)),
    *(of(durand.fix_uncertain, MEAN, K, sigma_s=s) for s in (2.0, 0.3, 9.0, 0.41)),
    of(durand.fix_uncertain, MEAN, K * 0 + 9, sigma_s=2.0),
    *(of(durand.layers, lL, sigma_s=2.0, **k) for k in ({}, {"sigma_r": 0.1})),
    *(of(durand.base_range, lL, **k) for k in ({}, {"cut": 0.1}, {"cut": 0})),
    of(durand.base_range, RNG.random((600, 900)).astype(np.float32)),
    *(of(durand.compress, lL, a, b, **k) for a, b, k in ((-3, 2, {}), (-3, 2, {"contrast": 5.0}), (1, 1.5,
        {}), (1, 1, {}))),
    of(durand.combine, lL, PHI),
    *(of(durand.tonemap, s) for s in (L, HOLES, TINY, FLAT, DARK)),
    *(of(durand.tonemap, L, **k) for k in ({"contrast": 9.0, "sigma_s": 3.0, "sigma_r": 0.2, "cut": 0.1},
        {"contrast": 1}, {"contrast": INF}, {"cut": -0.1}, {"cut": 0.5}, {"cut": 0})),
    *(of(fattal.find_range, v, *a) for v, a in ((LN.ravel(), ()), (LN.ravel(), (0.1, 0.2)), (LN[0, :2], ()),
        (LN[0, :1], (0.4, 0.4)))),
    of(fattal.find_range, RNG.random(2**18 * 2 + 5).astype(np.float32)),
    *(of(fattal.log_luminance, s) for s in (L, HOLES, FLAT, FAR)),
    *(of(fattal.slope, LN, *k) for k in ((), (1,), (3,))),
    *(of(fattal.attenuation, PHI, m, alpha=0.1, beta=b, noise=n) for m in (0.9, 0) for b, n in ((0.9, 0.01),
        (0.7, 0.9))),
    *(of(fattal.attenuation_steps, s, **k) for s, k in ((LN, {}), (np.log(LARGE), {}), (np.log(LARGE),
        {"alpha": 0.3, "beta": 0.8, "noise": 0.5}))),
    *(of(f, LN, PHI) for f in (fattal.attenuate_gradient, fattal.divergence)),
    *(of(fattal.display, s, **k) for s, k in ((LN, {}), (LN, {"black": 0.1, "white": 0.2}), (FLAT, {}))),
    *(of(fattal.tonemap, s) for s in (L, HOLES, DARK, TINY, FLAT)),
    of(fattal.tonemap, L, alpha=0.2, beta=0.8, noise=0.1, black=0.1, white=0.1),
    *(of(fattal.tonemap, L, **{k: v}) for k, v in (("alpha", 0), ("alpha", INF), ("beta", 0), ("beta", 1),
        ("beta", 1.1), ("noise", 0), ("noise", INF), ("black", 0), ("black", -0.1), ("black", 0.5), ("white",
        0), ("white", -0.1), ("white", 0.5))),
    *(of(local_laplacian.log_luminance, s) for s in (L, HOLES, FAR)),
    *(of(local_laplacian.remap, LN, g, sigma=0.7, alpha=a, beta=b) for g, a, b in ((0.0, 1.0, 0.0), (1.3,
        0.5, 0.4))),
    *(of(local_laplacian.filter_steps, s, sigma=0.7, alpha=0.8, beta=0.2, samples=n) for s, n in ((LN[:9,
        :8], 4), (FLAT, 2))),
    of(local_laplacian.filtered, LN, sigma=0.5, alpha=1.2, beta=0.1, samples=5),
    *(of(local_laplacian.tonemap, s) for s in (L, HOLES, DARK, TINY, FLAT)),
    of(local_laplacian.tonemap, RNG.lognormal(0, 1, (513, 600)), samples=2),
    *(of(local_laplacian.tonemap, L, **k) for k in ({"sigma": 0.3, "alpha": 0.7, "beta": 0.3, "samples": 6},
        {"sigma": 0.009}, {"sigma": 0.01}, {"sigma": INF}, {"alpha": 0}, {"alpha": INF}, {"beta": -0.1},
        {"beta": 1.1}, {"beta": 1}, {"samples": 1}, {"samples": 2})),
    *(of(f, nu) for f in (quality.sensitivity, quality.threshold) for nu in (1.0, 8.0)),
    of(quality.visible, np.array([0, 1, 1.5, 3, 9]), 4.0),
    of(quality.window_means, Y),
    *(of(f, X, Y, *a) for f, a in ((quality.deviations, ()), (quality.local_fidelity, (4.0,)))),
    of(quality.deviations, X * 0 + 7, Y),
    of(quality.deviations, EVEN, EVEN[::-1]),
    of(quality.local_fidelity, Y / 40, Y[::-1] / 60, 4.0),
    of(quality.scale_fidelities, np.tile(X, (6, 4))[:352, :352], np.tile(Y, (6, 4))[:352, :352]),
    *(of(quality.halve, a) for a in (Y, Y[:5, :7])),
    *(of(f, a, b) for f in (quality.scale_fidelities, quality.structural_fidelity) for a, b in ((X, Y),
        (X[:11, :11], Y[:11, :11]), (X[:10, :30], Y[:10, :30]), (X[:3, :4], Y[:3, :4]), (X[:22, :23], Y[:22,
        :23]))),
    *(of(f, a) for f in (quality.brightness, quality.contrast, quality.block_deviation, quality.naturalness)
        for a in (Y, Y[:25, :13], Y[:4, :5], np.indices((22, 22)).sum(0) % 2 * 255.0)),
    of(quality.overall, 0.8, 0.3),
    *(of(quality.scale_luminance, s) for s in (L, DARK, FLAT, L / L.max() / 2)),
    *(of(quality.tmqi, a, b) for a, b in ((L, GRAY), (LARGE, BIG), (L, BIG), (FLAT, GRAY))),
    *(of(reinhard.log_average, s, **k) for s, k in ((L, {}), (HOLES, {}), (HOLES, {"delta": 0.1}), (DARK,
        {}))),
    *(of(reinhard.automatic_key, s) for s in (L, HOLES, DARK, FLAT, ROW)),
    *(of(reinhard.scale_to_key, L, **k) for k in ({}, {"key": 0.5})),
    *(of(reinhard.white_point, s) for s in (LM, LM / 99, np.arange(20000.0))),
    *(of(reinhard.display, LM, LM[::-1], *w) for w in ((), (2.0,))),
    of(reinhard.response, LM, LM[::-1], width=2.0),
    of(reinhard.response, LM, LM[::-1], width=2.0, key=0.5, phi=2.0),
    *(of(adapted, k) for k in ({}, {"key": 0.5, "phi": 4.0, "threshold": 0.2}, {"threshold": 1e-9})),
    *(of(reinhard.local_adaptation, LM, **k) for k in ({}, {"key": 0.5, "phi": 4.0, "threshold": 0.2})),
    *(of(reinhard.tonemap, s, **k) for s in (L, HOLES, DARK, FLAT) for k in ({}, {"local": True},
        {"key": "auto"})),
    *(of(reinhard.tonemap, L, **k) for k in ({"key": 0.5, "white": 2.0, "local": True, "phi": 3.0,
        "threshold": 0.3}, {"key": 0}, {"key": "other"}, {"threshold": 0}, {"white": 0}, {"white": 1})),
    *(of(reinhard.as_light, s) for s in (L, L[0], -L, L * INF, L > 3, np.ma.masked_less(L, 1), L[:0], GRAY)),
    *(of(transfer.within, v, 2.0) for v in ([0, 1, 2], [-0.1], [2.0000021], [2.0000019], [NAN])),
    *(of(f, v) for f, v in ((transfer.pq, [0, 0.1, 100, 10000]), (transfer.pq_inverse, [*V, 0.02]),
        (transfer.hlg, [*V, 1 / 12, 1 / 13, 1 / 11]), (transfer.hlg_inverse, [*V, 0.499, 0.501]))),
    *(of(transfer.display_light, V, **k) for k in ({}, {"peak": 400.0})),
    *(of(transfer.codes, f, 0.1, 0.9, **k) for f in (transfer.pq, transfer.hlg) for k in ({}, {"bits": 8})),
    *(of(ward.foveal_image, s, **k) for s, k in ((L, {}), (LARGE, {}), (L, {"field": 7.0}), (L.T,
        {"field": 9.5}), (ONE, {"field": 1.0}))),
    *(of(ward.average_rows, L, n) for n in (1, 2.5, 40)),
    *(of(ward.histogram, s, low=0.1, high=9.0, **k) for s in (L, HOLES) for k in ({}, {"bins": 7})),
    of(ward.ceiling, 30.0, 0.2, 3.0),
    of(ward.trim, STEPS, 0.5, 3.0),
    *(of(ward.adjust_steps, STEPS, db, 3.0, **k) for db in (0.5, 0.3) for k in ({}, {"tolerance": 0.3})),
    of(ward.cumulative, ward.Trim(STEPS, 9.0, 25.0, 4.0)),
    of(ward.fill_gaps, ward.Trim(STEPS, 9.0, 25.0, 4.0), 0.5, 6.0),
    of(ward.equalise, V, black=0.5, white=80.0),
    *(of(ward.curve, s) for s in SCENES),
    of(ward.curve, L, black=0.5, white=1e4, bins=9, field=7.0, tolerance=0.1),
    *(of(ward.curve, L, **k) for k in ({"black": 0}, {"black": 100.0}, {"white": INF}, {"bins": 0},
        {"bins": 1}, {"field": 0}, {"tolerance": 0}, {"tolerance": 1}, {"white": 1.5}, {"white": 1e9})),
    of(ward.display, HOLES, np.log([0.1, 1, 9]), np.log([1, 20, 90.0]), black=1.0, white=90.0),
    *(of(ward.tonemap, s) for s in SCENES),
    of(ward.tonemap, L, black=0.5, white=1e4, bins=9, field=7.0, tolerance=0.1),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__)
