"""The arrays that everyone works on: a scene whose radiance is known, and its photographs.

E        radiance (H, W, 3) float32: the room of `scenes.computed`, its contrast stretched to 6.5 decades
bracket  7 photographs, 2 stops apart, 8 bits, response of film, noise of a large sensor

They are simulated once per folder and read from it afterwards, so that every process has the same
ones.
"""

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.capture.responses import true_g
from hdrlab.core.arrays import Array, NDArray
from hdrlab.core.bracket import Bracket, bracket
from scenes.computed import view

# 2 and 12 megapixels
SMALL = (1224, 1632)
LARGE = (3000, 4000)
PIXELS = LARGE[0] * LARGE[1] / (SMALL[0] * SMALL[1])
FRAMES = 7
DECADES = 6.5
FULL_WELL = 50_000.0
READ_NOISE = 3.0
RESPONSE = "film"
SEEN = (5, 250)  # between these levels a photograph measures a pixel
Size = tuple[int, int]


def scene(folder: Path, size: Size = SMALL) -> NDArray[np.float32]:
    """Return E."""

    def make() -> Array:
        E = view.room(size, samples=2 if size == SMALL else 1)
        return (E / np.median(E)) ** np.float32(DECADES / scenes.decades(E, tail=0))

    return stored(folder, f"scene-{size[0]}", make)


def photographs(folder: Path, size: Size = SMALL, *, radius: int = 0) -> Bracket:
    """Return the photographs, from a tripod or from a hand that shakes by up to `radius` pixels."""
    E = scene(folder, size)
    times = camera.times_around(E, FRAMES)

    def make() -> Array:
        shot = camera.shoot(
            E,
            times,
            camera.Camera(response=RESPONSE, full_well=FULL_WELL, read_noise=READ_NOISE),
            offsets=moves(radius),
            rng=1,
        )
        return shot.images

    return bracket(stored(folder, f"photographs-{size[0]}-{radius}", make), times)


def moves(radius: int) -> NDArray[np.int64]:
    """Return where each photograph must move to lie on the one in the middle."""
    return camera.shake(FRAMES, radius=radius, rng=7)


def response() -> NDArray[np.float64]:
    """Return g (256, 3), the camera's own, as a calibration of each channel would give it."""
    return np.stack([true_g(RESPONSE)] * 3, axis=-1)


def log_error(E: Array, truth: Array, images: Array) -> float:
    """Return the RMS of log10 E / truth, up to a scale, where a photograph measures all channels."""
    low, high = SEEN
    seen = ((images > low) & (images < high)).all(axis=-1).any(axis=0)
    off = np.log10(E[seen] / truth[seen])
    return float(np.sqrt(np.mean((off - np.median(off)) ** 2)))


def curve_error(g: Array) -> float:
    """Return the RMS error of f^-1 over the levels 10 to 250, in % of its top, against the camera's own."""
    estimate = np.exp(np.reshape(g, (256, -1))[10:251])
    own = np.exp(np.reshape(true_g(RESPONSE), (256, -1))[10:251])
    # the scale is free
    estimate = estimate * (estimate * own).sum(axis=0) / (estimate**2).sum(axis=0)
    return float(100 * np.sqrt(np.mean((estimate - own) ** 2)) / own.max())


def stored(folder: Path, name: str, make: Callable[[], Array]) -> Array:
    """Return the array of that name in the folder, made if it is not there."""
    path = folder / f"{name}.npy"
    if not path.exists():
        unfinished = folder / f"{name}.part.npy"
        np.save(unfinished, make())
        os.replace(unfinished, path)
    return np.load(path)
