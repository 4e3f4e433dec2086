"""What the functions of `core` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded

from hdrlab.core import (
    arrays,
    bracket,
    colour,
    extremes,
    gainmap,
    gamut,
    metrics,
    picture,
    sampling,
    transfer,
    weights,
)

NAN, INF = np.nan, np.inf
RNG = np.random.default_rng(3)
E = RNG.lognormal(0, 1.5, (11, 9, 3)).astype(np.float32)
L = RNG.lognormal(0, 2, (10, 13)).astype(np.float32)
L[0, :4], L[5, 5] = 0, 1e-31
Z8 = RNG.integers(0, 256, (3, 7, 8), np.uint8)
Z8C = RNG.integers(0, 256, (2, 6, 9, 3), np.uint8)
Z16 = RNG.integers(0, 65536, (2, 5, 6), np.uint16)
VALID = RNG.random((3, 7, 8)) > 0.1
MASKED = np.ma.masked_array(
    np.ones((2, 2, 2), np.uint8), mask=np.eye(2, dtype=bool)[None].repeat(2, 0)
)
RAMP = np.log(np.arange(1, 257.0))
RAMPS = np.stack([RAMP, RAMP * 0.9, RAMP + 1], axis=-1)
CURVE = np.log(np.linspace(0.01, 1, 256) ** 2.2)
ONES, ZEROS = np.ones((2, 3), np.float32), np.zeros((2, 3), np.float32)
LIT = np.array(
    [
        [[8.0, 4, 2], [0.1, 0.2, 0.9], [3, 0, 0], [0, 0, 0]],
        [[0, 1, 0], [1, 1, 1], [5, 5, 0.1], [40, 1, 1]],
    ]
)
LD = np.array([[0.3, 0.5, 0.9, 0.25], [0.7, 1.0, 0.95, 0.999]])
DARK = np.float32([[0.99e-30, 1e-30, 1.01e-30, 2e-30]])
DIM = DARK[..., None] * np.float32([0.5, 1, 2])
HDR = np.linspace(0, 6, 3000).reshape(50, 60) ** 2
WRONG = np.array(
    [
        [[0.2, 0.4, -0.1], [NAN, 1, 1], [0.2, 0.4, INF]],
        [[-0.1, -0.2, -INF], [-1, -2, -3], [0, -1e-3, 0]],
    ]
)
NOISY = RNG.normal(0.3, 1, (7, 8, 3)).astype(np.float32)
GAPS = np.where(RNG.random((7, 8)) > 0.4, NAN, RNG.random((7, 8)))
BLACK = np.full((5, 6, 3), NAN)
A2, B2 = [0, 5, 2, 0, 3, 1, 0, 0], [0, 0, 4, 4, 1, 0, 2, 0]
KNOTS = [0.0, 0.0031307, 0.0031308, 0.0031309, 0.04044, 0.04045, 0.04046, 0.5, 1.0]
TOPS = np.float32([0, 0.2, 1, 1.01, 3])[None]

CASES = recorded.named(
    *(of(arrays.describe, a) for a in (Z8, np.empty((0, 3)), np.array(["a"]), MASKED, [1.23456789, 2],
        [True])),
    *(of(arrays.hidden, a) for a in (MASKED, Z8)),
    *(of(arrays.as_stack, a) for a in (Z8, list(Z8C), Z16, [Z8[0], Z16[0]], [], 3, Z8[0], Z8C[..., :2],
        Z8C[None])),
    *(of(arrays.as_stack, a) for a in (Z8[:0], Z8.astype(int), MASKED, [Z8[0], Z8[1, :3]], list(MASKED))),
    *(of(arrays.as_times, *a) for a in (([1, 2], 2), ([1, 2], 3), ([0, 1], 2), ([1, INF], 2), (["a", "b"],
        2))),
    of(arrays.as_times, [1, 1, 2], 3, distinct=2),
    of(arrays.as_times, [1, 1, 2], 3, distinct=3),
    of(arrays.as_times, [1, 1], 2),
    of(arrays.as_mask, None, Z8),
    *(of(arrays.as_mask, valid, Z8) for valid in (VALID, VALID.astype(int), VALID[:2], VALID[0])),
    of(arrays.as_mask, np.ma.masked_array(VALID, mask=VALID), Z8),
    *(of(arrays.as_radiance, a) for a in (E, L, E[None], E[0, 0], E[..., :2], E[:0], -E, np.full((2, 2),
        1e39))),
    *(of(arrays.as_radiance, a) for a in (ONES.astype(bool), ZEROS, np.full((2, 2), NAN),
        np.ma.masked_less(L, 1))),
    *(of(arrays.as_luminance, a) for a in (L, E, L[0], L[:0], L - 1e-3, [[1, 2]])),
    *(of(arrays.as_picture, a) for a in (Z8[0], Z8C[0], Z8, Z16[0], Z8[0, 0], Z8[0, :0], MASKED[0])),
    *(of(arrays.levels, a) for a in (Z8, Z16)),
    *(of(arrays.to_256, a) for a in (Z8, Z16, np.array([0, 128, 129, 385, 386, 65406, 65407, 65535],
        np.uint16))),
    *(of(arrays.as_response, *a) for a in ((RAMP, 256, 1), (RAMP, 256, 3), (RAMPS, 256, 3), (RAMPS, 256, 1))),
    *(of(arrays.as_response, *a) for a in ((RAMP, 65536, 1), (RAMP[:200], 256, 1), (RAMP[::-1], 256, 1))),
    *(of(arrays.as_response, RAMP * 80 / RAMP[-1] * s, 256, 1) for s in (1, 1 + 1e-12, 0)),
    *(of(arrays.as_table, *a) for a in ((RAMP, 256), (RAMPS, 511), ([1, 2], 5), ([1], 5), ([1, NAN], 2), (E,
        11))),
    *(of(arrays.as_table, *a) for a in ((["a", "b"], 2), (MASKED[0], 2), ([[1, 2], [3, 5]], 3))),
    of(bracket.bracket, Z8, [3, 1, 2]),
    of(bracket.bracket, Z8, [3, 1, 2], ["c", "a", "b"], valid=VALID, linear=True),
    of(bracket.bracket, Z8, [1, 2, 3], valid=VALID),
    of(bracket.bracket, Z8, [1, 1, 0.5]),
    of(bracket.bracket, Z8, [1, 2, 3], ["a", "b"]),
    of(bracket.short_to_long, Z8, np.array([1.0, 1, 1])),
    *(of(colour.luminance, a) for a in (E, L, LIT)),
    *(of(colour.recolour, LIT, colour.luminance(LIT), LD, saturation=s) for s in (1, 0, 0.6, 1.7, -0.1, INF)),
    of(colour.recolour, LIT, colour.luminance(LIT), LD),
    of(colour.recolour, LD, LD, LD * 1.2),
    of(colour.recolour, DIM, DARK, DARK * 1e29),
    of(colour.recolour, LIT, LD[:1], LD),
    of(colour.recolour, LIT, LD, LD[:, :3]),
    *(of(curve, KNOTS) for curve in (colour.encode_srgb, colour.decode_srgb)),
    *(of(curve, np.linspace(0, 1, 50)) for curve in (colour.encode_srgb, colour.decode_srgb)),
    *(of(colour.to_8bit, a) for a in (np.linspace(0, 1.1, 300)[None], TOPS, LIT)),
    *(of(colour.render, LIT, colour.luminance(LIT), LD, saturation=s, way="hue") for s in (1, 0, 0.6, 1.7)),
    *(of(colour.render, LIT, colour.luminance(LIT), LD, saturation=s) for s in (1, 0, 0.6, 1.7, -1)),
    of(colour.render, E, colour.luminance(E), np.minimum(colour.luminance(E) / 4, 1), way="hue"),
    of(colour.render, E * 4, colour.luminance(E), np.full((11, 9), 0.9), way="hue"),
    of(colour.render, np.float32([4, 1, 1]) * E, colour.luminance(E), np.full((11, 9), 1.3), way="hue"),
    *(of(colour.render, DIM, DARK, DARK * 3e29, saturation=s, way="hue") for s in (1, 0.5)),
    of(colour.render, L, L, L / 9),
    of(colour.render, L, L, L / 9, way="other"),
    of(extremes.positive, L),
    of(extremes.positive, E[..., 0]),
    *(of(f, a) for f in (extremes.robust_minimum, extremes.robust_maximum) for a in (L, ZEROS, ONES, L[:1,
        3:5])),
    *(of(f, L, cut=0.1) for f in (extremes.robust_minimum, extremes.robust_maximum)),
    *(of(f, np.arange(1, 6e5).reshape(1, -1)) for f in (extremes.robust_minimum, extremes.robust_maximum)),
    *(of(f, np.arange(1, 2**18 + 1).reshape(1, -1)) for f in (extremes.robust_minimum,
        extremes.robust_maximum)),
    *(of(extremes.positive_median, np.float32([a])) for a in ([1], [1, 2], [3, 1, 2], [0, 4, 1, 2, 3], L[:,
        3])),
    *(of(extremes.decades, L, tail=t) for t in (0, 0.001, 0.1, 0.49, 0.5, -0.1)),
    of(extremes.decades, E),
    of(extremes.decades, ZEROS),
    of(gainmap.log_gain, HDR / 36, HDR),
    of(gainmap.log_gain, np.array([0.0, 0.5, 1]), np.array([0.0, 2, 8]), k=(0.01, 0.02)),
    *(of(gainmap.find_range, a) for a in (HDR, ONES, np.stack([HDR, -HDR, HDR * 2], axis=-1))),
    *(of(gainmap.gain_map, np.array([0.5, 0.5, 1]), np.array([0.5, 1, 8]), 0.2, 4, gamma=g) for g in (1, 2,
        0.5)),
    of(gainmap.gain_map, HDR / 36, HDR, -1, 6, k=(0.1, 0.2)),
    *(of(gainmap.weight, *a) for a in ((1, 8), (2, 8), (3, 8), (8, 8), (16, 8), (0.5, 8))),
    of(gainmap.apply_gain, np.array([0.5, 0.5, 1]), np.array([0, 0.5, 1]), -1, 2),
    of(gainmap.apply_gain, np.array([0.5, 0.5, 1]), np.array([0, 0.5, 1]), -1, 2, W=0.3, gamma=2, k=(0.1,
        0.3)),
    of(gainmap.expose, E, np.where(E > 2, 0.5, 0), 4.0),
    of(gainmap.expose, E * 0 + 5, E * 0, 9.0),
    of(gainmap.expose, E, np.minimum(E / 3, 1), 4.0),
    of(gainmap.expose, E * 0, np.minimum(E, 1), 4.0),
    of(gainmap.expose, np.where(E > 1, E, 0), np.where(E > 0.5, np.minimum(E, 1), 0), 9.0),
    *(of(gamut.sanitize, a) for a in (WRONG, NOISY, GAPS, BLACK, NOISY[..., 0], E, L, E[0, 0], E[:0],
        [["a"]], ONES * 5)),
    of(gamut.sanitize, NOISY, weights=(0.3, 0.6, 0.1)),
    of(gamut.sanitize, np.full((2, 2), 1e39)),
    of(gamut.sanitize, E[..., :2]),
    of(gamut.sanitize, np.ma.masked_less(L, 1)),
    of(gamut.mean_known, NOISY, NOISY[..., 0] > 0.5),
    of(gamut.mean_known, E[:5, :5], np.eye(5) * np.arange(5) > 3),
    *(of(gamut.desaturate, NOISY, power=p) for p in (1, 2)),
    of(gamut.desaturate, NOISY, weights=(0.5, 0.7, -0.2)),
    of(gamut.desaturate, NOISY[..., 0]),
    of(gamut.desaturate, NOISY),
    *(of(gamut.xyz_matrix, p) for p in (gamut.SRGB, gamut.WIDE["bt2020"], gamut.WIDE["p3"])),
    *(of(gamut.conversion_matrix, p) for p in gamut.WIDE.values()),
    of(gamut.conversion_matrix, gamut.SRGB, gamut.WIDE["p3"]),
    of(gamut.conversion_matrix, (*gamut.SRGB[:6], 0.3333, 0.3333)),
    of(gamut.to_srgb, E, gamut.WIDE["bt2020"]),
    *(of(metrics.response_rmse, *a) for a in ((RAMP * 1.1, RAMP), (RAMPS, RAMP), (RAMPS, RAMPS[:, ::-1]),
        (CURVE, RAMP))),
    *(of(metrics.response_rmse, *a) for a in ((RAMP, RAMPS), (RAMP, RAMP[::-1]))),
    of(metrics.well_exposed, np.array([[[9, 10, 11, 249, 250, 251]], [[0, 9, 255, 251, 255, 255]]],
        np.uint8)),
    of(metrics.well_exposed, Z8C),
    of(metrics.well_exposed, Z16),
    of(metrics.well_exposed, Z8, VALID),
    of(metrics.radiance_errors, L, L**1.1, L > 0.5),
    of(metrics.radiance_errors, E, E**0.9, E[..., 0] > 0.5),
    *(of(metrics.radiance_errors, L, *a) for a in ((L, L), (L[1:], L > 0), (L * 0, L > 0), (L, L > 1e9), (L,
        L[1:] > 0))),
    of(metrics.radiance_errors, L * 0, L, L > 0),
    of(metrics.offset_errors, [[0, 3], [1, 3], [5, -2], [0, 1]], [[0, 1], [1, 1], [4, -4], [0, 0]]),
    *(of(metrics.offset_errors, a, b) for a, b in (([1, 2], [1, 2]), ([[1, 2, 3]] * 2, [[1, 2, 3]] * 2),
        ([[1, 2]], [1, 2]))),
    *(of(picture.gray, a) for a in (Z8[0], Z8C[0])),
    *(of(picture.statistics, a) for a in (Z8[0], Z8C[0], [[0, 0, 128, 255]], np.zeros((2, 2), np.uint8))),
    of(picture.statistics, np.array([[[0, 0, 0], [0, 255, 3], [0, 0, 1], [255, 255, 255]]], np.uint8)),
    *(of(sampling.by_rank, Z8, n) for n in (1, 5, 56)),
    of(sampling.by_rank, Z8C, 7),
    of(sampling.by_rank, Z16, 7),
    of(sampling.by_rank, Z8, 7, valid=VALID),
    of(sampling.by_rank, np.broadcast_to(np.arange(250, dtype=np.uint8), (1, 4 * 4000, 250)), 9),
    *(of(sampling.by_grid, a, n) for a in (Z8[:1, :1], Z8[:, :5, :3]) for n in (1, 2, 3, 5, 7, 14)),
    *(of(sampling.by_grid, Z8, n) for n in (0, 1, 2, 12, 56, 80)),
    *(of(sampling.by_grid, a, 20) for a in (Z8C, Z16, Z8[:, :1], Z8[..., :1])),
    of(sampling.by_grid, Z8, 20, valid=VALID),
    *(of(sampling.every_pixel, a, 3) for a in (Z8, Z8C, Z16)),
    of(sampling.every_pixel, Z8, 3, valid=VALID),
    of(sampling.every_pixel, Z8, 3, valid=VALID[:2]),
    of(sampling.every_pixel, Z8, 3, valid=VALID & False),
    *(
        of(sampling.require_two_exposures, Z, t, weights.hat())
        for Z, t in (
            ([[9, 8]], [1, 2]), ([[9, 9]], [1, 2]), ([[9, 8]], [1, 1]), ([[0, 8]], [1, 2]), ([[9, 8]], [1]),
            ([[9.0, 8]], [1, 2]), ([[9, 9]] * 50 + [[8, 9]], [1, 2]), ([[9, 9], [8, 8]], [1, 2]),
        )
    ),
    *(of(transfer.histograms, a) for a in (Z8, Z8C, Z16)),
    of(transfer.histograms, Z8, VALID),
    of(transfer.histograms, Z8[:1, :1, :1]),
    of(transfer.brightness_transfer, [0, 1, 1, 2, 0], [0, 2, 0, 1, 1]),
    of(transfer.brightness_transfer, [1, 3, 0, 0, 0], [0, 2, 2, 0, 0]),
    *(of(transfer.cumulate, h, 4) for h in ([1, 0, 2, 1], [0, 0, 0, 0], [1, -1, 2, 1], [1, 2, 3])),
    *(of(f, a, b) for f in (transfer.brightness_transfer, transfer.literal_transfer) for a, b in ((A2, B2),
        (B2, A2))),
    of(transfer.brightness_transfer, [1, 2, 1, 0], [1, 2, 1, 0]),
    of(transfer.brightness_transfer, [0, 2, 2, 0], [0, 1, 2, 1]),
    *(of(f, n) for f in (weights.hat, weights.gaussian, weights.flat) for n in (5, 6, 7)),
    *(of(f) for f in (weights.hat, weights.gaussian, weights.flat)),
    of(weights.cut, weights.hat()),
    of(weights.cut, np.ones(11), above=0.8, below=0.2),
    *(of(weights.cut, np.ones(3), above=a, below=b) for a, b in ((1, 0), (1.01, 0), (1, -0.01), (0.5, 0.5),
        (0.5, 0.4))),
    of(weights.snr, CURVE),
    of(weights.snr, np.log([1.0, 2, 2.02, 2.03, 2.03, 2.04, 2.5, 9, 11]), span=1),
    of(weights.snr, np.log([1.0, 2, 2.005, 2.01, 9, 99, 999]), span=1),
    of(weights.snr, RAMPS),
    of(weights.snr, CURVE, least=2.0, span=1),
    of(weights.snr, np.log([1.0, 1, 1, 4, 5, 9])),
    *(of(weights.snr, g) for g in ([1, 2, 3.0], [1, 2.0], [1, NAN, 2], [3, 2, 1.0], [1, 2, 1.0], E)),
    of(weights.second_differences, np.arange(1, 7.0), 3.0),
    of(weights.make_monotone, np.array([[4.0, 1, 3, 2, 5, 4, 6, 1, 9]]).T),
    *(of(weights.make_monotone, np.array(g)) for g in ([-1.0, -2, 0, 2, 1], [3.0, 1, 2, 2, 0, 4], [[1.0, 2],
        [0, 3], [5, 1]])),
)  # fmt: skip


def test_where_the_curves_of_srgb_meet_the_line_holds():
    assert colour.encode_srgb(0.0031308) == 12.92 * 0.0031308
    assert colour.decode_srgb(0.04045) == 0.04045 / 12.92


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__)
