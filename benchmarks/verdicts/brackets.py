"""Brackets as cameras take them: measured responses, noise, sharpening, JPEG.

E        radiance       (H, W, 3) float32 of an embedded scene, 0.18 MP
t        times          (P,) s
Z        photographs    (P, H, W, 3) uint8, through the camera and its JPEG

Bracket i is the same in every run: scene, response, number of frames, steps, quality are drawn with
seed i. An ill takes part at three places: in the light that a frame sees, in its levels, and in the
times stated.
"""

import io
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter

from benchmarks.experiments import Skipped, measured_curves
from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.capture.hand_motion import views
from hdrlab.capture.responses import as_response
from hdrlab.core.arrays import Array, NDArray
from hdrlab.core.bracket import Bracket, bracket

SHAPE = (344, 516)
SCENES = (*scenes.PLACES, "room")
SOUND = (
    "plain",
    "noise reduction",
    "black and white ends",
    "somebody far away",
    "by hand",
    "bright lamps",
    "dark ground",
    "by hand, lamps, dark ground",
)
# of the photographs' exposure, that the scene's middle is moved by, stops
OFF_CENTRE = 1.5
# A sound bracket leaves at most this fraction of the pixels black, below this level, in every photo.
MAX_BLACK_FRACTION = 0.03
LOWEST_LEVEL = 10
MAX_FRAMES = 8
# Shifts of a hand, pixels each way.
SHIFT_RADIUS = 8
# Lamps: their number, their radii in pixels, and their exposure in the shortest photo.
LAMP_COUNT = 6
LAMP_RADII = (2, 8)
LAMP_EXPOSURE = 8.0
# Dark ground: the fraction of the rows that it covers, and what is left of their light.
GROUND_FRACTION = 0.3
GROUND_FACTOR = 1 / 30
# electrons at ISO 100
FULL_WELL, READ_NOISE = 40_000.0, 4.0
Float = NDArray[np.float64]
Response = Callable[[Array], Array]


class Plan(NamedTuple):
    """How bracket i is taken."""

    i: int
    scene: str
    curve: tuple[Float, Float] | str
    times: Float
    quality: int
    sharpness: float
    sound: str
    offsets: NDArray[np.int64] | None = None

    @property
    def frames(self) -> int:
        """The number of frames."""
        return len(self.times)

    @property
    def one(self) -> int:
        """The frame that an ill of one frame has: in the middle for even i, at an end for odd i."""
        return self.frames // 2 if self.i % 2 == 0 else (0, self.frames - 1)[self.i // 2 % 2]


class Ill(NamedTuple):
    """What goes wrong: functions of the Plan, the frame, a generator, and light, levels, or stated times.

    What moves is compared with its photographs at rest, as the middle frame sees it.
    """

    title: str
    moves: bool = False
    light: Callable[[Plan, int, np.random.Generator, Array], Array] = lambda plan, j, rng, E: E
    levels: Callable[[Plan, int, np.random.Generator, Array], Array] = lambda plan, j, rng, Z: Z
    times: Callable[[Plan, Float], Float] = lambda plan, t: t


NONE = Ill("nothing")


@cache
def radiance(name: str) -> NDArray[np.float32]:
    """Return E of a scene."""
    return np.asarray(getattr(scenes, name)(SHAPE), np.float32)


@cache
def darken_ground(name: str) -> NDArray[np.float32]:
    """Return E of a scene whose lowest rows lie in the dark, behind a soft edge."""
    rows = np.arange(SHAPE[0])
    depth = (rows - (1 - GROUND_FRACTION) * SHAPE[0]) / 10
    factor = GROUND_FACTOR ** np.clip(depth, 0, 1)
    return (radiance(name) * factor[:, None, None]).astype(np.float32)


def add_lamps(E: Array, shortest: float, rng: np.random.Generator) -> Array:
    """Return E with round lamps that clip in every photo."""
    lit = E.copy()
    rows, columns = np.indices(SHAPE)
    for _ in range(LAMP_COUNT):
        row = rng.uniform(0, SHAPE[0])
        column = rng.uniform(0, SHAPE[1])
        radius = rng.uniform(*LAMP_RADII)
        is_lamp = np.hypot(rows - row, columns - column) < radius
        lit[is_lamp] = LAMP_EXPOSURE / shortest
    return lit


@cache
def curves(folder: Path) -> tuple[Float, Float] | None:
    """Return the exposures and brightnesses of the measured responses, (201, n) each, or None."""
    try:
        return measured_curves(folder)
    except Skipped:
        return None


def plan(folder: Path, i: int, *, sound: str = "", seed: int = 0) -> Plan:
    """Return the Plan of bracket i: a sound one of this kind, or one for an ill."""
    rng = np.random.default_rng((20, seed, SOUND.index(sound), i) if sound else (15, i))
    measured = curves(folder)
    scene = SCENES[i % len(SCENES)]
    count, stops = int(rng.integers(3, 8)), rng.uniform(1, 2.3)
    if count < 5:
        stops = max(stops, 1.5)
    ends = sound == "black and white ends"
    off_center = rng.choice([-1, 1]) * OFF_CENTRE * (2 if ends else rng.uniform(0, 1))
    k = int(rng.integers(201))
    curve = (measured[0][k], measured[1][k]) if measured else ("film", "srgb", "gamma")[k % 3]
    E = darken_ground(scene) if "dark ground" in sound else radiance(scene)
    times = camera.times_around(E, count, stops=stops, middle=0.1 * 2**off_center)
    if sound:
        times = extend_times(E, times, find_response(curve))
    quality = int(rng.integers(75, 96))
    sharpness = rng.uniform(0, 1)
    offsets = None
    if "by hand" in sound:
        offsets = camera.shake(times.size, radius=SHIFT_RADIUS, rng=rng)
    return Plan(i, scene, curve, times, quality, sharpness, sound, offsets)


def find_response(curve: tuple[Float, Float] | str) -> Response:
    """Return the response that a camera takes: a name, or a function of the exposure."""
    if isinstance(curve, str):
        return as_response(curve).f
    return lambda X: np.interp(X, *curve)


def extend_times(E: Array, times: Float, f: Response) -> Float:
    """Return the times, with longer ones where the photos leave too many pixels black.

    A bracket that leaves more of them is not sound: it deserves the warning that it gets.
    """
    factor = times[1] / times[0]
    brightest = E.max(axis=-1)
    while times.size < MAX_FRAMES:
        levels = 255 * f(np.clip(brightest * times[-1], 0, 1))
        if np.mean(levels < LOWEST_LEVEL) <= MAX_BLACK_FRACTION:
            break
        times = np.append(times, factor * times[-1])
    return times


def shoot(plan: Plan, ill: Ill = NONE, *, at_rest: bool = False) -> Bracket:
    """Return the photographs of a plan with an ill, or of what moves in it at rest."""
    response = find_response(plan.curve)
    images = []
    for j, t in enumerate(plan.times):
        k = plan.frames // 2 if at_rest else j
        noise, own = (np.random.default_rng((16, plan.i, *which)) for which in ((0, j), (1, k)))
        E = ill.light(plan, k, own, still(plan, j))
        # where time stays and ISO makes the exposure
        iso = 2.0**j if plan.sound == "noise reduction" else 1.0
        model = camera.Camera(response=response, full_well=FULL_WELL / iso, read_noise=READ_NOISE)
        Z = camera.shoot(E, [t], model, rng=noise).images[0]
        if plan.sound == "noise reduction":
            Z = np.rint(gaussian_filter(Z.astype(np.float32), (0.25 * j, 0.25 * j, 0))).astype(
                np.uint8
            )
        images.append(finish(plan, ill.levels(plan, k, own, Z)))
    stated = ill.times(plan, plan.times)
    order = np.argsort(stated, kind="stable")
    return bracket(np.stack(images)[order], stated[order])


def still(plan: Plan, j: int) -> Array:
    """Return the light of the scene in photo j, which only somebody far away and the hand change."""
    E = darken_ground(plan.scene) if "dark ground" in plan.sound else radiance(plan.scene)
    if "lamps" in plan.sound:
        E = add_lamps(E, plan.times[0], np.random.default_rng((19, plan.i)))
    if plan.offsets is not None:
        return np.asarray(views(E, plan.offsets)[j])
    if plan.sound != "somebody far away":
        return E
    h, w = SHAPE
    y, x = h // 2 + plan.i % 40, w // 4 + 12 * j + plan.i % 90
    walked = E.copy()
    walked[y : y + 18, x : x + 6] = np.median(E) / 3
    return walked


def finish(plan: Plan, Z: Array) -> Array:
    """Return a photograph sharpened and through a JPEG of 4:2:0."""
    soft = Z.astype(np.float32)
    sharp = soft + plan.sharpness * (soft - gaussian_filter(soft, (1, 1, 0)))
    file = io.BytesIO()
    picture = Image.fromarray(np.clip(np.rint(sharp), 0, 255).astype(np.uint8))
    picture.save(file, "JPEG", quality=plan.quality, subsampling=2)
    return np.asarray(Image.open(file))
