"""The table and figure 7 of Wilburn, Xu and Matsushita 2008: `mixtures` states the simulated set-up.

Table 1 has ten sets for each of five cameras, seed 0; the 201 measured curves have one photograph
each, with seed k. The paper's table has the means of RMSE and disparity.
"""

from collections.abc import Mapping
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from benchmarks.experiments import (
    Experiment,
    along,
    at_least,
    at_most,
    listed,
    measured_curves,
    spread,
)
from benchmarks.papers import mixtures as setup
from hdrlab.calibration import motion_blur

Float = NDArray[np.float64]
WAYS = {"display": setup.by_display, "blur": setup.by_motion_blur}
WAY_NAMES = {"display": "the display", "blur": "blur"}
# RMSE, disparity, variance
PUBLISHED = {
    "display": (0.012, 0.017, 0.050),
    "blur": (0.012, 0.029, 0.052),
}
LIMITS = {"display": (0.001, 0.003, 0.008), "blur": (0.0005, 0.002, 0.006)}
RMSE = "RMSE: median, 95 %, worst"
DISPARITY = "disparity, mean"
TRIALS = 100
SETS = 10
MITSUNAGA = "0.006, 0.017, 0.061"  # without two outliers of ten sets
ACCEPTED = "linear motion accepted"
REJECTED = "acceleration by 15 % rejected"


def sets(name: str, *, count: int = SETS) -> dict[str, list[float]]:
    """Return RMSE, disparity and variance of every way for a camera, means over the sets."""
    ways = setup.table1(name, sets=count).items()
    return {
        way: [errors.rmse.mean(), errors.disparity.mean(), setup.variance(errors)]
        for way, errors in ways
    }


def table1(_: Path) -> Mapping[str, ArrayLike]:
    """Return table 1 for each of the cameras."""
    cameras = zip(setup.NAMES, along(sets, setup.NAMES, "cameras"), strict=True)
    return {f"{name}, {way}": figures for name, ways in cameras for way, figures in ways.items()}


def one_curve(curve: tuple[int, Float, Float], way: str) -> tuple[float, float]:
    """Return RMSE and disparity of a measured curve (k, exposure, brightness) from one photograph."""
    k, exposure, brightness = curve
    recovered = WAYS[way]([setup.measured(exposure, brightness)], seed=k)
    return float(recovered.rmse[0]), float(recovered.disparity[0])


def measured(folder: Path, way: str, *, every: int = 1) -> Mapping[str, ArrayLike]:
    """Return the errors of our spline over every so many of the measured curves."""
    exposure, brightness = measured_curves(folder)
    items = [(k, exposure[k], brightness[k]) for k in range(0, len(exposure), every)]
    rmse, disparity = np.transpose(along(partial(one_curve, way=way), items, way))
    return {
        RMSE: spread(rmse),
        DISPARITY: disparity.mean(),
        "disparity: median, 95 %, worst": spread(disparity),
    }


def trial(seed: int) -> tuple[float, float]:
    """Return the RMSE between left and right edges, of linear and of accelerated motion."""
    linear, accelerated = setup.figure7(trials=1, seed=seed)
    return float(linear[0]), float(accelerated[0])


def figure7(_: Path, *, trials: int = TRIALS) -> Mapping[str, ArrayLike]:
    """Return how often left and right edges tell linear motion from accelerated."""
    linear, accelerated = np.transpose(along(trial, range(trials), "motions"))
    return {
        ACCEPTED: np.sum(linear < motion_blur.MAX_RMSE),
        REJECTED: np.sum(accelerated > motion_blur.MAX_RMSE),
        "largest RMSE of linear, smallest of accelerated": [linear.max(), accelerated.min()],
    }


ROWS = (
    Experiment(
        "wilburn-table1",
        f"display and motion blur, five cameras; RMSE, disparity, variance, means of {SETS} sets",
        table1,
        tuple(
            at_most(
                f"{name}, {way}, {curve}",
                *PUBLISHED[way][:2],
                np.inf,
                published=listed(PUBLISHED[way]),
            )
            for name in setup.NAMES
            for way in WAYS
            for curve in ("polynomial", "spline")
        ),
        {
            f"{name}, mitsunaga, ratios off by {100 * off:.0f} %": MITSUNAGA
            for name in setup.NAMES
            for off in setup.OFF
        },
    ),
    *(
        Experiment(
            f"wilburn-{way}",
            f"a monotone spline over 201 measured curves, by {WAY_NAMES[way]}",
            partial(measured, way=way),
            (
                at_most(RMSE, *LIMITS[way], published=f"{PUBLISHED[way][0]} (mean)"),
                at_most(DISPARITY, PUBLISHED[way][1], published=str(PUBLISHED[way][1])),
            ),
        )
        for way in WAYS
    ),
    Experiment(
        "wilburn-figure7",
        f"the left edge against the right one, {TRIALS} motions each",
        figure7,
        (
            at_least(ACCEPTED, TRIALS, published="RMSE < 0.01"),
            at_least(REJECTED, TRIALS, published="RMSE 0.028"),
        ),
    ),
)
