"""Pictures of brackets in which something went wrong, for the page on what `assemble` says of them.

Each is a bracket of an embedded scene, three photographs side by side.
"""

import re
from collections.abc import Callable
from functools import partial

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.core.filters.warp import sample, turn
from hdrlab.core.types import F32, Array
from hdrlab.show import pictures

SHAPE = (160, 240)
# stops between two of the photographs
STOPS = 2.0


def take_three(E: F32, gains: tuple[float, ...] = (1, 1, 1)) -> list[Array]:
    """Return three photographs, each of which saw so many times the light."""
    times = camera.times_around(E, 3, stops=STOPS) * gains
    return [camera.shoot(E, [t], camera.Camera(response="srgb")).images[0] for t in times]


def by_place(E: F32) -> list[Array]:
    """Return photographs that were brightened where they are dark."""
    local = [(Z, gaussian_filter(Z.mean(axis=-1) + 8, 8)[..., None] / 128) for Z in take_three(E)]
    return [np.clip(Z * L**-0.4, 0, 255).astype(np.uint8) for Z, L in local]


def corners(E: F32) -> list[Array]:
    """Return photographs of which the last has dark corners."""
    y, x = np.mgrid[-1 : 1 : SHAPE[0] * 1j, -1 : 1 : SHAPE[1] * 1j]
    return [*take_three(E)[:2], take_three(E * (1 - 0.4 * (y**2 + x**2)).astype(np.float32)[..., None])[2]]


def turned(E: F32) -> list[Array]:
    """Return photographs of which the last was turned by four degrees."""
    return [*take_three(E)[:2], take_three(np.maximum(sample(E, turn(SHAPE, 4), SHAPE), 1e-3))[2]]


def walker(E: F32) -> list[Array]:
    """Return photographs through which somebody walks."""
    place = scenes.layers("street", SHAPE)
    return [take_three(scenes.compose(place, (0, 40 * j - 40)))[j] for j in range(3)]


# by the name in the page: the scene, what happens to it, and what the picture shows
CASES: dict[str, tuple[str, Callable[[F32], list[Array]], str]] = {
    "times": ("workshop", partial(take_three, gains=(1, 1, 0.25)), "the last is no brighter for its time"),
    "place": ("workshop", by_place, "in each the dark corners of the room were brightened by the camera"),
    "corners": ("chapel", corners, "the corners of the last are darker than those of the others"),
    "turned": ("workshop", turned, "the last is turned by four degrees"),
    "moved": ("street", walker, "somebody walks past, and is elsewhere in each"),
    "black": ("chapel", partial(take_three, gains=(1 / 256, 1, 1)), "the first is nearly black"),
}


def show_case(name: str) -> str:
    """Return the HTML of a case's three photographs, from short to long, with alternative text."""
    scene, happens, shows = CASES[name]
    frames = happens(np.asarray(getattr(scenes, scene)(SHAPE), np.float32))
    row = np.hstack([np.pad(Z, ((0, 0), (3, 3), (0, 0)), constant_values=255) for Z in frames])
    alt = f"Three photographs of the {scene}, from short to long: {shows}."
    return pictures.picture(row, alt=alt)._repr_html_()


def illustrate(text: str) -> str:
    """Return a page with the pictures of the cases it names: `<!-- case: times -->`."""
    return re.sub(r"<!-- case: (\w+) -->", lambda found: show_case(found[1]), text)
