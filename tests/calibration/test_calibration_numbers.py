"""What the functions of `calibration` answer to some input, written down: `recorded`."""

from functools import partial as of

import numpy as np
import pytest
import recorded

from hdrlab.calibration import blends, chart, display, joining, motion_blur, wilburn
from hdrlab.calibration.blends import Blend

RNG = np.random.default_rng(29)
INF, NAN = np.inf, np.nan
I = np.linspace(0.05, 1, 12)  # noqa: E741  (the paper's letter)
BLENDS = [
    Blend(I, np.clip(s * I + r, 0, 1) ** (1 / 2.2)) for s, r in ((0.9, 0.0), (0.4, 0.0), (0.3, 0.5))
]
SCALED = [Blend(I, (s * I) ** (1 / 2.2)) for s in (0.95, 0.4)]
RESCALED = blends.rescale(BLENDS)
M9 = np.linspace(0.1, 0.9, 30)
CURVE = blends.InverseResponse(M9, M9**2.2, np.array([0.9, 0.4]), np.zeros(2))
OTHER = blends.InverseResponse(M9 - 0.05, M9**2, np.array([0.9, 0.4]), np.zeros(2))
G = blends.GRID**2
SMALL = display.Schedule(high=(220, 90), rows=2, columns=3, steps=7, patch=6, border=4)
FILM = display.draw_schedule(SMALL, shape=(60, 50))
SEEN = FILM.mean(axis=0)
PICTURE = np.rint(255 * (SEEN / 255) ** (1 / 2.2)).astype(np.uint8)
CORNERS = np.array([[11.5, 13.0], [37.5, 12.5], [38, 47.5], [11, 48]])
COLOUR = np.stack([PICTURE, PICTURE // 2, PICTURE], axis=-1)
SQUARE = np.array([[0, 0], [10, 0], [10, 8], [0, 8]])
LEANING = SQUARE + np.array([[0.5, 1], [-1, 0.3], [0, 1], [1, 0]])
CHART = RNG.integers(20, 230, (50, 70), np.uint8)
FRAME = [[3, 4], [65, 3], [66, 45], [2, 46]]
EDGE = np.zeros((20, 90))
for k in range(20):
    EDGE[k] = np.interp(
        np.arange(90), [20 + k / 3, 40 + k / 3, 55, 75 - k / 5], [0.001, 0.97, 0.97, 0.001]
    )
BLURRED = np.rint(255 * EDGE ** (1 / 2.2)).astype(np.uint8)
BENT = np.rint(255 * np.where(np.arange(90) < 50, EDGE ** (1 / 2.2), EDGE)).astype(np.uint8)
RAMPS = motion_blur.find_ramps(BLURRED)
NEUTRAL_M = (chart.NEUTRAL ** (1 / 2.2))[[0, 2, 1, 3, 4, 5]]
PATCHES = np.clip(np.multiply.outer([0.125, 0.25, 0.5, 1, 2.0], [0.1, 0.3, 0.6]), 0, 1) ** (1 / 2.2)


def constants():
    """Return what a chart is like, and a schedule."""
    return chart.ROWS, chart.COLUMNS, chart.GAP, chart.LUMINANCE, chart.NEUTRAL, display.DEFAULT


constants.__module__ = "hdrlab.calibration.chart"
LOOSE = {f"calibration.{name}": 2e-4 for name in ("wilburn.join_steps", "wilburn.join")}
LOOSE |= {
    f"calibration.{name}": 2e-5
    for name in ("joining.join_steps", "joining.join", "motion_blur.join")
}
CASES = recorded.named(
    *(of(blends.make_blend, i, m, **k) for i, m, k in ((I, BLENDS[0].M, {}), (I, BLENDS[2].M, {"low": 0.7,
        "high": 0.8}), ([1, 2, 3, 4], [15 / 255, 240 / 255, 14.9 / 255, 240.1 / 255], {}))),
    *(of(blends.make_blend, i, m, **k) for i, m, k in (([1], [1, 2], {}), ([[1]], [[1]], {}), ([NAN], [1],
        {}), ([1], [INF], {}), ([1], [1], {"low": 1.0}), ([1], [0.5], {"low": -0.1}), ([1], [0.5],
        {"high": 1.1}), ([1], [0.5], {"low": 0, "high": 1}))),
    *(of(blends.select_blends, b, **k) for b, k in ((BLENDS, {}), ([*BLENDS, Blend(I[:2], I[:2]),
        Blend(I * 0, I), Blend(I, I * 0)], {}), ([Blend(I[:3], I[:3])], {}), ([Blend(I[:2], I[:2])], {}),
        (BLENDS, {"min_samples": 13}))),
    *(of(f, BLENDS) for f in (blends.brightness_range, blends.rescale)),
    of(blends.normalize, M9, M9**2, np.array([2.0, 3]), np.array([0.5, 1])),
    *(of(blends.build_response, BLENDS, G, np.array([0.9, 0.4, 0.3]), np.array([0.0, 0.1, 0.4]), ends=e)
        for e in (0, 0.005, 0.24, 0.25, -0.01)),
    *(of(blends.difference, CURVE, OTHER, **k) for k in ({}, {"fit": True})),
    *(of(blends.difference, CURVE, OTHER._replace(M=M9 + d)) for d in (0.8, 0.79, 0.9)),
    of(blends.rmse, CURVE, OTHER),
    *(of(blends.ln_exposure, CURVE, **k) for k in ({}, {"black": 0.005}, {"n": 64}, {"black": 0.1**2.2},
        {"black": 0.1})),
    of(blends.ln_exposure, CURVE._replace(X=np.minimum(CURVE.X, 0.5))),
    of(constants),
    *(of(chart.homography, a, b) for a, b in ((SQUARE, LEANING), (LEANING, SQUARE), (SQUARE[:3], SQUARE),
        (SQUARE * NAN, SQUARE), (SQUARE[[0, 2, 1, 3]], SQUARE), (SQUARE * [1, 0], SQUARE), (SQUARE[::-1],
        SQUARE))),
    of(chart.homography, SQUARE * [1, 1e-5], SQUARE),
    *(of(chart.read_patches, z, CORNERS, 4, 3, **k) for z, k in ((PICTURE, {}), (COLOUR, {"gap": 0.5}),
        (PICTURE, {"gap": 4 / 6, "core": 0.9}), (PICTURE.astype(np.uint16), {"core": 1}))),
    *(of(chart.read_patches, PICTURE, CORNERS, r, c, **k) for r, c, k in ((0, 3, {}), (4, 0, {}), (1, 1, {}),
        (4, 3, {"gap": -0.1}), (4, 3, {"core": 0}), (4, 3, {"core": 1.1}), (50, 60, {}))),
    *(of(chart.read_patches, PICTURE, SQUARE * [4.9 * a, 7.4375 * b] + d, 2, 2) for a, b, d in ((1, 1, -0.5),
        (1, 1, -0.51), (1.0101, 1, 0), (1.011, 1, 0), (1, 1.0001, 0), (1, 1.001, 0.1))),
    *(of(chart.read_chart, CHART, FRAME, **k) for k in ({}, {"gap": 0.3, "core": 0.4})),
    *(of(chart.recover_gray, *a) for a in ((NEUTRAL_M, chart.NEUTRAL[[0, 2, 1, 3, 4, 5]]), ([0.2, 0.5, 0.9],
        [0.1, 0.3, 0.8]), ([0.2, 0.5], [0.1, 0.3]), ([0.2, 0.5, 0.4], [0.1, 0.3, 0.8]), ([0.2, 0.5, 0.9],
        [0.1, 0.3, 0.3]), ([0.2, 0.2, 0.9], [0.1, 0.2, 0.3]))),
    of(chart.recover_gray, chart.NEUTRAL ** (1 / 2.2)),
    *(of(chart.recover_bracket, m, t) for m, t in ((PATCHES, [0.125, 0.25, 0.5, 1, 2]), (PATCHES[:, 0], [1,
        2]), (PATCHES, [1, 2]))),
    *(of(chart.read_bracket, z, FRAME, **k) for z, k in (([CHART, CHART // 2], {}),
        (np.stack([np.stack([CHART] * 3, axis=-1)] * 2), {"gap": 0.3}))),
    *(of(display.mixing_ratios, *a) for a in ((), (2, 3, 7), (2, 3, 6), (2, 3, 5), (0, 3, 5), (2, 0, 5))),
    *(of(display.draw_patches, np.array([[9, 5], [1, 7]], np.uint8), patch=p, border=b, shape=s) for p, b,
        s in ((2, 1, (7, 8)), (3, 0, (6, 6)))),
    *(of(display.draw_schedule, *a, **k) for a, k in (((SMALL,), {"shape": (60, 50)}),
        ((SMALL._replace(low=20, border=0),), {"shape": (24, 18)}), ((SMALL,), {"shape": (36, 26)}))),
    *(of(display.draw_schedule, SMALL, shape=s) for s in ((35, 26), (36, 25))),
    *(of(display.draw_schedule, SMALL._replace(**{k: v}), shape=(60, 60)) for k, v in (("high", ()), ("high",
        (256,)), ("high", (255,)), ("low", -1), ("low", 90), ("low", 89), ("patch", 0), ("patch", 1),
        ("border", -1))),
    of(display.draw_schedule),
    *(of(display.find_corners, z) for z in (PICTURE, PICTURE[:, ::-1], FILM[0], PICTURE * 0, PICTURE[0],
        COLOUR, np.eye(4), np.eye(5)[:1], np.eye(5)[:, :1])),
    of(display.find_corners, np.array([[25, 26, 0], [100, 0, 26], [0, 26, 25]])),
    *(of(display.read_blends, z, CORNERS, SMALL, **k) for z, k in ((PICTURE, {}), (COLOUR, {"core": 0.3,
        "low": 0.2, "high": 0.8}))),
    *(of(display.recover_display, p, CURVE) for p in ([220, 100], [100, 220], [1])),
    of(joining.knots, 8),
    of(joining.i_splines, np.array([-0.1, 0, 0.2, 0.5, 0.99, 1, 1.2]), 7),
    of(joining.slope_curvature, blends.GRID + 0.5, 8),
    *(of(joining.build_equations, RESCALED, np.concatenate([b.M for b in RESCALED]),
        np.ones(1024) + blends.GRID, 7, o) for o in (True, False)),
    of(joining.eliminate, M9[:12].reshape(4, 3) ** 2, np.eye(4)[:, :2], np.arange(4.0)),
    *(of(joining.solve_increments, joining.build_equations(RESCALED, np.concatenate([b.M for b in RESCALED]),
        np.ones(1024), 7, o), 0.1 * joining.slope_curvature(np.ones(1024), 7), o) for o in (True, False)),
    of(joining.update, RESCALED, np.concatenate([b.M for b in RESCALED]), np.ones(1024), count=8,
        smoothness=1e-4, offset=True),
    of(joining.predict_brightness, RESCALED, joining.State(G, G, np.array([0.8, 0.4, 0.3]), np.array([0, 0.1,
        0.5]), 0.0)),
    *(of(joining.join_steps, b, **k) for b, k in ((BLENDS, {}), (SCALED, {"offset": False}), (BLENDS,
        {"count": 8, "smoothness": 1e-3, "tolerance": 0.01}), (BLENDS, {"max_iterations": 2}))),
    *(of(joining.join_steps, BLENDS, **{k: v}) for k, v in (("count", 5), ("count", 6), ("smoothness", -1),
        ("max_iterations", 0), ("max_iterations", 1))),
    *(of(joining.join, b, **k) for b, k in ((BLENDS, {}), (SCALED, {"offset": False}), (BLENDS, {"count": 9,
        "smoothness": 1e-3, "ends": 0.1}))),
    *(of(motion_blur.classify, EDGE[k], low=0.1, high=0.9, width=w) for k in (0, 9) for w in (1, 5)),
    *(of(motion_blur.straighten_edges, [motion_blur.Ramp(k, 9 + k // 2 + (k == 3) * d, 40 + k // 2, True)
        for k in range(n)]) for n, d in ((7, 0), (7, 3), (7, 9), (2, 9), (3, 1))),
    *(of(motion_blur.find_ramps, BLURRED, **k) for k in ({}, {"low": 0.2, "high": 0.7, "width": 3},
        {"shortest": 19}, {"shortest": 30}, {"shortest": 2}, {"shortest": 3}, {"width": 0}, {"width": 1},
        {"low": -0.1}, {"high": 1.1}, {"low": 0.95}, {"low": 0, "high": 1})),
    *(of(motion_blur.find_ramps, z) for z in (BENT, COLOUR, BLURRED.astype(np.uint16) * 257)),
    of(motion_blur.read_blends, BLURRED, RAMPS[:4]),
    *(of(motion_blur.join, BLURRED, *a, **k) for a, k in (((), {}), ((RAMPS[:5],), {"smoothness": 1e-2,
        "ends": 0.1}))),
    *(of(motion_blur.compare_edges, z, *a, **k) for z, a, k in ((BLURRED, (), {}), (BENT, (), {}), (BENT, (),
        {"limit": 0.9}), (BLURRED, ([one for one in RAMPS if one.rises],), {}))),
    of(wilburn.complete, np.array([0.2, -0.1])),
    of(wilburn.evaluate, M9[:5], np.array([0, 0.5, 0.2, 0.3])),
    of(wilburn.quadratic_form, RESCALED, 3),
    of(wilburn.error, [0, 1, 2], np.diag([1.0, 2, 3])),
    *(of(wilburn.join_steps, BLENDS, **k) for k in ({"degree": 2, "runs": 1}, {"degree": 3, "runs": 2},
        {"degree": 1}, {"runs": 0})),
    of(wilburn.join, BLENDS, degree=3, runs=1, ends=0.1),
)  # fmt: skip


@pytest.mark.parametrize("function", CASES)
def test_the_same_numbers_come_for_the_same_input(function):
    recorded.check(CASES, function, __file__, LOOSE.get(function, recorded.TOLERANCE))
