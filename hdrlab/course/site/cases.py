"""Pictures of brackets in which something went wrong, for the page on what `assemble` says of them.

Each is a bracket of an embedded scene, three photographs side by side, or a detail of the map.
"""

import re
from collections.abc import Callable

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.core.types import F32, Array
from hdrlab.core.warp import sample, turn
from hdrlab.show import pictures

SHAPE = (160, 240)
# stops between two of the photographs
STOPS = 2.0
Frames = list[Array]


def shoot(E: F32, *, gains: tuple[float, ...] = (1, 1, 1), middle: float = 0.1) -> Frames:
    """Return three photographs, each of which saw so many times the light."""
    times = camera.times_around(E, 3, stops=STOPS, middle=middle) * gains
    return [camera.shoot(E, [t], camera.Camera(response="srgb")).images[0] for t in times]


def wrong_time(E: F32) -> Frames:
    """Return a bracket whose last photograph got no more light than the one before."""
    return shoot(E, gains=(1, 1, 1 / 2**STOPS))


def by_place(E: F32) -> Frames:
    """Return photographs that were brightened where they are dark."""
    frames = shoot(E)
    local = [gaussian_filter(Z.mean(axis=-1) + 8, 8)[..., None] / 128 for Z in frames]
    return [np.clip(Z * one**-0.4, 0, 255).astype(np.uint8) for Z, one in zip(frames, local, strict=True)]


def corners(E: F32) -> Frames:
    """Return photographs of which the last has dark corners."""
    y, x = (np.linspace(-1, 1, n) for n in SHAPE)
    falloff = 1 - 0.4 * (y[:, None] ** 2 + x**2)[..., None]
    return [np.rint(Z * falloff).astype(np.uint8) if j == 2 else Z for j, Z in enumerate(shoot(E))]


def white(E: F32) -> Frames:
    """Return photographs of which the middle one is warmer."""
    gains = np.array([1.3, 1, 0.7])
    return [np.clip(Z * gains, 0, 255).astype(np.uint8) if j == 1 else Z for j, Z in enumerate(shoot(E))]


def turned(E: F32) -> Frames:
    """Return photographs of which the last was turned by four degrees."""
    return [*shoot(E)[:2], shoot(np.maximum(sample(E, turn(SHAPE, 4), SHAPE), 1e-3))[2]]


def walker(E: F32) -> Frames:
    """Return photographs through which somebody walks."""
    place = scenes.layers("street", SHAPE)
    return [shoot(scenes.compose(place, (0, 40 * j - 40)))[j] for j in range(3)]


def black(E: F32) -> Frames:
    """Return photographs of which the first is nearly black."""
    return shoot(E, gains=(1 / 256, 1, 1))


# by the name in the page: the scene, what happens to it, and what the picture shows
CASES: dict[str, tuple[str, Callable[[F32], Frames], str]] = {
    "times": (
        "workshop",
        wrong_time,
        "the last is as bright as the one before, in four times the time",
    ),
    "place": ("workshop", by_place, "in each the dark corners of the room were brightened by the camera"),
    "corners": ("chapel", corners, "the corners of the last are darker than those of the others"),
    "colours": ("workshop", white, "the middle one is much warmer than its neighbours"),
    "turned": ("workshop", turned, "the last is turned by four degrees"),
    "moved": ("street", walker, "somebody walks past, and is elsewhere in each"),
    "black": ("chapel", black, "the first is nearly black, so it shares no level with the second"),
}


def show_case(name: str) -> str:
    """Return the HTML of a case's three photographs, from short to long, with alternative text."""
    scene, happens, shows = CASES[name]
    frames = happens(np.asarray(getattr(scenes, scene)(SHAPE), np.float32))
    gap = np.full((SHAPE[0], 6, 3), 255, np.uint8)
    row = np.hstack([frames[0], gap, frames[1], gap, frames[2]])
    return pictures.picture(
        row, alt=f"Three photographs of the {scene}, from short to long: {shows}."
    )._repr_html_()


def illustrate(text: str) -> str:
    """Return a page with the pictures of the cases it names: `<!-- case: times -->`."""
    return re.sub(r"<!-- case: (\w+) -->", lambda found: show_case(found[1]), text)
