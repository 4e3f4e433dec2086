"""The default response compared with each method alone, on brackets of cameras that were measured.

error    root mean square over levels 10 to 250, in stops, the best unit for each channel: median, 95 %, worst
gray     the largest ratio of two channels' radiances of a gray wall, over the same levels: the same three
spread   stops, what the map of all pixels leaves

Cameras: eight of Grossberg and Nayar's 201 curves, evenly picked; no prior here was fitted to them. Scenes:
the embedded ones at 240 x 360 pixels, in turn. Photographs: JPEG of quality 92, a well of 20 000
electrons, noise of 5; three and four frames 2 stops apart, five, seven and nine 1 stop; the seed is
the curve's number.
"""

import io
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from benchmarks.experiments import Experiment, along, at_most, measured_curves, spread
from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.core import weights
from hdrlab.core.bracket import Bracket
from hdrlab.core.metrics import RELIABLE_LEVELS
from hdrlab.diagnostics import consistency
from hdrlab.fast.merge import merge_with_quality
from hdrlab.pipeline import recovery
from hdrlab.response import families

Float = NDArray[np.float64]
METHODS = ("auto", "debevec", "space", "robertson")
STOPS = {3: 2.0, 4: 2.0, 5: 1.0, 7: 1.0, 9: 1.0}
CAMERAS = range(0, 201, 28)
PLACES = (scenes.chapel, scenes.workshop, scenes.street, scenes.room)


def photographs(exposure: Float, brightness: Float, frames: int, k: int) -> Bracket:
    """Return JPEGs of a camera with this measured curve."""
    E = PLACES[(k + frames) % len(PLACES)]((240, 360))
    sensor = camera.Camera(
        response=lambda X: np.interp(X, exposure, brightness), full_well=20_000, read_noise=5
    )
    taken = camera.shoot(E, camera.times_around(E, frames, stops=STOPS[frames]), sensor, rng=k)
    images = []
    for image in taken.images:
        file = io.BytesIO()
        Image.fromarray(image).save(file, "jpeg", quality=92)
        images.append(np.asarray(Image.open(file)))
    return replace(taken, images=np.stack(images))


def figures(case: tuple[int, int, Float, Float]) -> dict[str, tuple[float, float, float]]:
    """Return error, gray and spread of each method on (frames, k, exposure, brightness)."""
    frames, k, exposure, brightness = case
    taken = photographs(exposure, brightness, frames, k)
    errors = {}
    true = families.invert_curves(exposure, brightness)[0][RELIABLE_LEVELS, None]
    for name in METHODS:
        choice = recovery.choose_response(name, taken)
        g = recovery.find_response(name, choice, taken).g
        off = (g[RELIABLE_LEVELS] - true) / np.log(2)
        error = np.sqrt(np.mean((off - off.mean(axis=0)) ** 2))
        E = merge_with_quality(taken.images, taken.times, g, weights.gaussian()).E
        left = consistency.measure_spread(
            consistency.measure_level_exposures(taken.images, taken.times, E)
        )
        errors[name] = (float(error), float(2 ** np.ptp(off, axis=1).max()), left)
    return errors


def compared(folder: Path) -> Mapping[str, ArrayLike]:
    """Return the figures of each method by the number of frames."""
    exposure, brightness = measured_curves(folder)
    cases = [(frames, k, exposure[k], brightness[k]) for frames in STOPS for k in CAMERAS]
    errors_of_cases = along(figures, cases, "brackets")
    summary: dict[str, ArrayLike] = {}
    for frames in STOPS:
        for name in METHODS:
            own = [
                values_of_camera[name]
                for case, values_of_camera in zip(cases, errors_of_cases, strict=True)
                if case[0] == frames
            ]
            for what, values in zip(("error", "gray", "spread"), np.array(own).T, strict=True):
                summary[f"{frames} frames, {name}, {what}"] = spread(values)
    return summary


ROWS = (
    Experiment(
        "response-auto",
        "the default response, measured cameras; error in stops, gray, spread: median, 95 %, worst",
        compared,
        (at_most("3 frames, auto, gray", 1.01, np.inf, np.inf),),
    ),
)
