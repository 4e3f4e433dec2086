"""201 measured responses (Grossberg and Nayar's collection), and what each method makes of their photographs.

error  RMSE of f^-1 over levels 10 to 250, percent of its value at 250

Stated here: the embedded room's green channel, 128 x 192 pixels; five frames 2 stops apart, around
the one that suits the scene; noise of Normal(0, 1) levels after the response, 256 levels; curve k
has seed k. Doubtful times are the true ones, each multiplied by a factor uniform in 0.9 ... 1.1,
drawn with seed (1, k). Where a method refuses brackets, a row says how many, and its errors are
those of the others.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from benchmarks.experiments import Experiment, along, at_most, measured_curves, spread
from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.core.bracket import Bracket
from hdrlab.core.metrics import response_rmse
from hdrlab.diagnostics import exposure_times as timing
from hdrlab.fast import debevec
from hdrlab.pipeline import catalogue, recovery
from hdrlab.response import families, self_calibration

Float = NDArray[np.float64]
Method = Callable[[Bracket], Float]
SHAPE = (128, 192)
FRAMES = 5
STOPS = 2.0
NOISE = 1.0
OFF = 0.1
DEFAULT = "debevec"
# smoothness for times that are still off by a little: they bend the curve where frames meet
STIFF = 100.0
BEST = "debevec, smoothness 100, mitsunaga's ratios"
ESTIMATED = "debevec, smoothness 100, estimated times"


@cache
def scene() -> NDArray[np.float32]:
    """Return E (H, W)."""
    return scenes.room(SHAPE)[..., 1]


def photographs(exposure: Float, brightness: Float, *, off: float, k: int) -> Bracket:
    """Return the bracket of a camera with this measured curve, its times off by up to a fraction."""
    taken = camera.shoot(
        scene(),
        camera.times_around(scene(), FRAMES, stops=STOPS),
        camera.Camera(response=lambda X: np.interp(X, exposure, brightness), gray_noise=NOISE),
        rng=k,
    )
    factors = 1 + off * np.random.default_rng([1, k]).uniform(-1, 1, FRAMES)
    return replace(taken, times=taken.times * factors)


def named(name: str, bracket: Bracket) -> Float:
    """Return g by a method of the catalogue, as it is offered."""
    return np.asarray(recovery.find_validated_method(name)(bracket.images, bracket.times))


def by_ratios(bracket: Bracket) -> Float:
    """Return g by stiff least squares, with ratios from self-calibration of order 5 where it can tell."""
    images = bracket.images
    times = bracket.times
    try:
        R = self_calibration.calibrate(images, times, order=5).R
    except ValueError:  # no pixels lie well in two neighbouring frames
        return debevec.recover(images, times, smoothness=STIFF)
    relative_times = np.cumprod(np.concatenate([[1], 1 / R]))
    return debevec.recover(images, relative_times * times[0], smoothness=STIFF)


def by_estimate(bracket: Bracket) -> Float:
    """Return g by stiff least squares, with times estimated as the pipeline does."""
    images = bracket.images
    times = bracket.times
    return debevec.recover(images, timing.estimate_times(images, times).times, smoothness=STIFF)


def methods(*others: str) -> dict[str, Method]:
    """Return every method that is offered, and these others."""
    own = {BEST: by_ratios, ESTIMATED: by_estimate}
    every = {name: partial(named, name) for name in catalogue.names("response")}
    return every | {name: own[name] for name in others}


def errors(
    curve: tuple[int, Float, Float], used: dict[str, Method], off: float
) -> dict[str, float]:
    """Return method -> error on the curve (k, exposure, brightness); NaN where it refuses."""
    k, exposure, brightness = curve
    bracket = photographs(exposure, brightness, off=off, k=k)
    errors_found = {}
    true = families.invert_curves(exposure, brightness)[0]
    for name, method in used.items():
        try:
            errors_found[name] = float(response_rmse(method(bracket), true)[0])
        except ValueError:
            errors_found[name] = float("nan")
    return errors_found


def compared(
    folder: Path, used: dict[str, Method], *, off: float = 0.0, which: Iterable[int] = range(201)
) -> Mapping[str, ArrayLike]:
    """Return median, 95 % and worst error of each method, and what it refused."""
    exposure, brightness = measured_curves(folder)
    items = [(k, exposure[k], brightness[k]) for k in which]
    errors_of_curves = along(partial(errors, used=used, off=off), items, "curves")
    summary: dict[str, ArrayLike] = {}
    for name in used:
        own = np.array([values[name] for values in errors_of_curves])
        summary[name] = spread(own[~np.isnan(own)])
        if refused := int(np.isnan(own).sum()):
            summary[f"{name}, brackets refused"] = refused
    return summary


def exact(folder: Path) -> Mapping[str, ArrayLike]:
    """Return every method's errors with the true times."""
    return compared(folder, methods())


def doubtful(folder: Path) -> Mapping[str, ArrayLike]:
    """Return every method's errors with times that are off, and those of what is offered for such times."""
    return compared(folder, methods(BEST, ESTIMATED), off=OFF)


ROWS = (
    Experiment(
        "curves",
        "201 measured responses, exact times; error of f^-1: median, 95 %, worst, %",
        exact,
        (at_most(DEFAULT, 0.4, 1.5, 3),),
    ),
    Experiment(
        "curves-doubtful",
        "the same, times off by up to 10 %",
        doubtful,
        (at_most(BEST, 0.6, 1.5, np.inf),),
    ),
)
