"""The experiments of Wilburn, Xu and Matsushita 2008, with cameras whose response is known.

f          response      exposure 0 to 1 -> brightness 0 to 1
RMSE       of f^-1       over the measured brightnesses, 15 to 240 of 255, as a fraction of its range there
disparity                the largest error there; as in the paper, both curves go from 0 to 1 over that range
variance                 of the errors of several sets at each brightness, the mean of that, in square
                         per cent: the paper gives no unit; as fractions its 0.05 exceeds the
                         squared RMSE
sigma      noise         0.005, after the response, of each pixel, before it is cut into 256 levels

Stated here, since the paper does not: the screen has gamma 2.2 and its brightest patch just
saturates the camera; a patch is 30 pixels wide in the photograph, the inner 27 are read; a scan
line crosses two ramps of 100 pixels between a white that saturates the camera, 1.05, and a black
without light; 300 scan lines, 60 for figure 7. Mitsunaga and Nayar's method gets four photographs
of 100 x 100 pixels of a scene, exposures stated as 1/8, 1/4, 1/2 and 1, with ratios that are off by
up to 5 % or, 0.45 ... 0.55 as in that paper, by 10 %; radiance is uniform in its logarithm over two
decades; the order is chosen by held-out error.
"""

from collections.abc import Callable, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hdrlab.calibration import display, joining, motion_blur, wilburn
from hdrlab.calibration.blends import (
    MAX_BRIGHTNESS,
    MIN_BRIGHTNESS,
    TABLE_SIZE,
    Blend,
    InverseResponse,
    difference,
    normalize,
)
from hdrlab.capture.responses import RESPONSES, as_response
from hdrlab.pipeline import recovery

Float = NDArray[np.float64]
Curve = Callable[[Float], Float]
GAMMA = 2.2
BRIGHTEST = 220
SIGMA = 0.005
WHITE = 1.05
BLACK = 0.0
RAMP = 100
LINES = 300
# of Mitsunaga and Nayar's method: photographs, and how far ratios are off
FRAMES = 4
OFF = (0.05, 0.1)
OUTLIERS = 0.2  # of its sets: the paper removed two of ten


class Errors(NamedTuple):
    """RMSE and disparity (C,), a camera or a set each, and the errors over the brightness (C, 1024)."""

    rmse: Float
    disparity: Float
    apart: Float


def measured(exposure: Float, brightness: Float) -> Curve:
    """Return the response through the points of a measured curve."""
    return lambda X: np.interp(X, exposure, brightness)


def truth(f: Curve, recovered: InverseResponse) -> InverseResponse:
    """Return f^-1 over the brightnesses of `found`; in the middle of the exposures where f is flat."""
    X = np.linspace(0, 1, 1 << 16)
    M, first, counts = np.unique(f(X), return_index=True, return_counts=True)
    at = np.linspace(recovered.M[0], recovered.M[-1], TABLE_SIZE)
    return InverseResponse(
        at, np.interp(at, M, (X[first] + X[first + counts - 1]) / 2), np.ones(0), np.ones(0)
    )


def photograph(
    f: Curve, X: Float, rng: np.random.Generator, *, sigma: float = SIGMA
) -> NDArray[np.uint8]:
    """Return the levels of round(255 (f(X) + noise))."""
    M = f(np.minimum(X, 1.0)) + sigma * rng.standard_normal(X.shape)
    return np.round(255 * np.clip(M, 0, 1)).astype(np.uint8)


@cache
def screen() -> tuple[Float, Float]:
    """Return the screen's light during one exposure (H, W), 1 for `BRIGHTEST`, and the grid's corners."""
    shown = display.draw_schedule(display.Schedule((BRIGHTEST, 100)), shape=(360, 300))
    return np.mean((shown / BRIGHTEST) ** GAMMA, axis=0), display.find_corners(shown[0])


def display_blends(f: Curve, rng: np.random.Generator) -> list[Blend]:
    """Return the two blends of one photograph of the screen."""
    light, corners = screen()
    return display.read_blends(photograph(f, light, rng), corners, core=0.9)[0]


def passing(x: Float, acceleration: float) -> Float:
    """Return t when the edge passes x = (t + a t^2 / 2) / (1 + a / 2): its speed grows by the fraction a."""
    if acceleration == 0:
        return x
    return (np.sqrt(1 + 2 * acceleration * (1 + acceleration / 2) * x) - 1) / acceleration


def blurred(
    f: Curve, rng: np.random.Generator, *, acceleration: float = 0.0, lines: int = LINES
) -> NDArray[np.uint8]:
    """Return scan lines (lines, W) across a moving dark region: white, ramp, black, ramp, white."""
    t = passing((np.arange(RAMP) + 0.5) / RAMP, acceleration)
    share = np.concatenate([np.ones(40), 1 - t, np.zeros(40), t, np.ones(40)])
    return photograph(f, np.tile(BLACK + (WHITE - BLACK) * share, (lines, 1)), rng)


def errors(cameras: Sequence[Curve], recovered: Sequence[InverseResponse]) -> Errors:
    """Return the Errors of the curves found for the cameras."""
    apart = np.stack(
        [
            difference(response, truth(f, response))
            for f, response in zip(cameras, recovered, strict=True)
        ]
    )
    return Errors(np.sqrt(np.mean(apart**2, axis=1)), np.abs(apart).max(axis=1), apart)


def variance(sets: Errors) -> float:
    """Return the variance over the sets of one camera, its mean over the brightnesses, in square per cent."""
    return float(np.mean(np.var(100 * sets.apart, axis=0, ddof=1)))


def by_display(
    cameras: Sequence[Curve], *, join: Callable[..., InverseResponse] = joining.join, seed: int = 0
) -> Errors:
    """Return the Errors of the display's method, one photograph per camera."""
    responses = [
        join(display_blends(f, np.random.default_rng([seed, k]))) for k, f in enumerate(cameras)
    ]
    return errors(cameras, responses)


def by_motion_blur(
    cameras: Sequence[Curve],
    *,
    join: Callable[..., InverseResponse] | None = None,
    seed: int = 0,
    lines: int = LINES,
) -> Errors:
    """Return the Errors of the method by motion blur, one photograph per camera, all its ramps together."""
    responses = []
    for k, f in enumerate(cameras):
        image = blurred(f, np.random.default_rng([seed, k]), lines=lines)
        responses.append(
            motion_blur.join(image)
            if join is None
            else join(motion_blur.read_blends(image, motion_blur.find_ramps(image)))
        )
    return errors(cameras, responses)


def without_outliers(sets: Errors) -> Errors:
    """Return the Errors but for the worst of them, as the paper does for Mitsunaga and Nayar's method."""
    kept = np.argsort(sets.rmse)[: len(sets.rmse) - int(OUTLIERS * len(sets.rmse))]
    return Errors(*(values[kept] for values in sets))


def self_calibrated(cameras: Sequence[Curve], *, off: float, seed: int = 0) -> Errors:
    """Return the Errors of Mitsunaga and Nayar's method, one bracket per camera, its ratios off by `off`."""
    responses = []
    stated = 2.0 ** np.arange(FRAMES)
    for k, f in enumerate(cameras):
        rng = np.random.default_rng([seed, k])
        E = 10 ** rng.uniform(-2, 0, (100, 100))
        R = 0.5 * (1 + off * rng.uniform(-1, 1, FRAMES - 1))
        exposures = np.append(np.cumprod(R[::-1])[::-1], 1)
        g = recovery.find_validated_method("mitsunaga")(
            np.stack([photograph(f, E * e, rng) for e in exposures]), stated
        )
        at = np.linspace(MIN_BRIGHTNESS, MAX_BRIGHTNESS, TABLE_SIZE)
        responses.append(
            normalize(at, np.interp(at, np.arange(256) / 255, np.exp(g)), np.ones(1), np.zeros(1))
        )
    return errors(cameras, responses)


def table1(name: str, *, sets: int = 10, lines: int = LINES, seed: int = 0) -> dict[str, Errors]:
    """Return the Errors (sets,) of a simulated camera: display and blur, his polynomial and our spline.

    And of the method they are compared with, without the worst fifth. Published means: RMSE 0.012,
    0.012 and 0.006, disparity 0.017, 0.029 and 0.017, `variance` 0.050, 0.052 and 0.061.
    """
    cameras = [as_response(name).f] * sets
    compared = {
        f"mitsunaga, ratios off by {100 * off:.0f} %": without_outliers(
            self_calibrated(cameras, off=off, seed=seed)
        )
        for off in OFF
    }
    return {
        "display, polynomial": by_display(cameras, join=wilburn.join, seed=seed),
        "display, spline": by_display(cameras, seed=seed),
        "blur, polynomial": by_motion_blur(cameras, join=wilburn.join, seed=seed, lines=lines),
        "blur, spline": by_motion_blur(cameras, seed=seed, lines=lines),
        **compared,
    }


def figure7(
    name: str = "film",
    *,
    trials: int = 100,
    acceleration: float = 0.15,
    lines: int = 60,
    seed: int = 0,
) -> tuple[Float, Float]:
    """Return the RMSE between left and right edges (trials,), of linear and of accelerated motion.

    Published: below 0.01 in the good example, 0.028 in the bad one; the limit is
    `motion_blur.MAX_RMSE`.
    """
    f = as_response(name).f
    rng = np.random.default_rng(seed)
    pairs = [
        [
            motion_blur.compare_edges(blurred(f, rng, acceleration=a, lines=lines)).rmse
            for a in (0.0, acceleration)
        ]
        for _ in range(trials)
    ]
    linear, accelerated = np.array(pairs).T
    return linear, accelerated


def screens_own(name: str = "film", *, seed: int = 0) -> tuple[Float, Float, Float]:
    """Return pixel values (9,), the screen's light as eight blends of one photograph give it, and the truth.

    The paper's closing remark: several blends calibrate the monitor, too.
    """
    high = (220, 200, 180, 160, 140, 120, 100, 80)
    schedule = display.Schedule(high, rows=1, columns=15)
    shown = display.draw_schedule(schedule, shape=(460, 880))
    light = np.mean((shown / BRIGHTEST) ** GAMMA, axis=0)
    image = photograph(as_response(name).f, light, np.random.default_rng(seed))
    read = display.read_blends(image, display.find_corners(shown[0]), schedule, core=0.9)
    P, light = display.recover_display(high, joining.join(read[0]))
    return P, light, (P / BRIGHTEST) ** GAMMA


NAMES = tuple(RESPONSES)
