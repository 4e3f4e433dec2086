"""Brackets with a truth: somebody or something moves through the embedded places, and nothing does.

Seven frames two stops apart, the camera's film response in 8 bits, a well of 50 000 electrons with
5 electrons of noise. In each place its visitor walks to the right; a warm ball flies across, eight
times as bright as the place's median; and a gray one rolls along, four times as dark.
"""

from collections.abc import Iterator
from functools import cache
from itertools import product

import numpy as np
from scipy.ndimage import shift

from hdrlab import scenes
from hdrlab.capture import camera, movers
from hdrlab.core.arrays import Array, NDArray
from hdrlab.core.bracket import Bracket
from hdrlab.scenes.places import PLACES, resample

FRAMES = 7
WHO = ("visitor", "bright ball", "dark ball")
SEQUENCES = tuple(product(PLACES, WHO))
CAMERA = camera.Camera(full_well=50_000, read_noise=5.0)
SHAPE = (256, 384)
STILL = (*PLACES, "room")
RNG = 1


@cache
def sequence(place: str, who: str, shape: tuple[int, int] = SHAPE) -> movers.Moving:
    """Return a bracket of a place with somebody in it, and its truth."""
    layers = scenes.layers(place, shape)
    # what is counted in pixels grows with the picture
    E = layers.radiance
    k = shape[1] / SHAPE[1]
    light = np.array([8, 4, 2] if who == "bright ball" else [0.25] * 3) * np.median(E)
    figure, step = {
        "visitor": (movers.Figure(layers.mover, layers.mask), (0, 12 * k)),
        "bright ball": (movers.ball(shape, (128 * k, 192 * k), 24 * k, light), (10 * k, 40 * k)),
        "dark ball": (movers.ball(shape, (150 * k, 192 * k), 24 * k, light), (0, 22 * k)),
    }[who]
    at = movers.path(FRAMES, step)
    times = camera.times_around(E, FRAMES, stops=2)
    return movers.shoot(E, figure, at, times, CAMERA, rng=RNG)


@cache
def radiance(place: str) -> NDArray[np.float32]:
    """Return the radiance of a place or of the room, 512 x 768."""
    return scenes.room() if place == "room" else scenes.layers(place).radiance


def still(place: str, shape: tuple[int, int] = SHAPE, *, rng: int = RNG) -> Bracket:
    """Return a bracket of a place from a tripod, in which nothing moves."""
    E = resample(radiance(place), shape)
    return camera.shoot(E, camera.times_around(E, FRAMES, stops=2), CAMERA, rng=rng)


def shaken(place: str, seed: int) -> Iterator[tuple[str, Bracket]]:
    """Yield two brackets of a still place from a hand that moved by up to half a pixel each way.

    One has half the scene's size: whole pixels of the scene are half ones of the picture. The other
    has its full size, and light between pixels is interpolated.
    """
    E = radiance(place)
    rng = np.random.default_rng(seed)
    times = camera.times_around(E, FRAMES, stops=2)
    height = E.shape[0] - 4
    width = E.shape[1] - 4
    coarse = []
    fine = []
    for j, t in enumerate(times):
        dy, dx = rng.integers(1, 3, 2, endpoint=True)
        view = resample(E[dy : dy + height, dx : dx + width], (height // 2, width // 2))
        coarse.append(photograph(view, t, 100 * seed + j))
        between = rng.uniform(-0.5, 0.5, 2)
        moved = [shift(E[..., c], between, order=1, mode="nearest") for c in range(3)]
        fine.append(photograph(np.stack(moved, axis=-1), t, 100 * seed + 50 + j))
    for size, images in (("half size", coarse), ("full size", fine)):
        names = tuple(f"frame {j + 1}" for j in range(FRAMES))
        yield size, Bracket(images=np.stack(images), times=times, names=names)


def photograph(E: Array, t: float, rng: int) -> Array:
    """Return one photograph of a scene."""
    return camera.shoot(E, [t], CAMERA, rng=rng).images[0]
