"""Pictures of brackets in which something went wrong, for the page on what `assemble` says of them.

Each is a bracket of an embedded scene, three photographs side by side. The site ships them:

    python -m scenes.cases -o hdrlab/course/site/pages/cases
"""

import argparse
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab import scenes
from hdrlab.capture import camera
from hdrlab.core.arrays import F32, Array
from hdrlab.core.filters.warp import sample, turn
from hdrlab.io import web

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
    return [
        *take_three(E)[:2],
        take_three(E * (1 - 0.4 * (y**2 + x**2)).astype(np.float32)[..., None])[2],
    ]


def turned(E: F32) -> list[Array]:
    """Return photographs of which the last was turned by four degrees."""
    return [*take_three(E)[:2], take_three(np.maximum(sample(E, turn(SHAPE, 4), SHAPE), 1e-3))[2]]


def walker(E: F32) -> list[Array]:
    """Return photographs through which somebody walks."""
    place = scenes.layers("street", SHAPE)
    return [take_three(scenes.compose(place, (0, 40 * j - 40)))[j] for j in range(3)]


# by the name in the page: the scene, and what happens to it
CASES: dict[str, tuple[str, Callable[[F32], list[Array]]]] = {
    "times": ("workshop", partial(take_three, gains=(1, 1, 0.25))),
    "place": ("workshop", by_place),
    "corners": ("chapel", corners),
    "turned": ("workshop", turned),
    "moved": ("street", walker),
    "black": ("chapel", partial(take_three, gains=(1 / 256, 1, 1))),
}


def main() -> None:
    """Write the three photographs of each case, from short to long, as a WebP file of its name."""
    parser = argparse.ArgumentParser(prog="python -m scenes.cases", description=__doc__)
    parser.add_argument("-o", "--out", type=Path, required=True, help="the folder to write to")
    out = parser.parse_args().out
    for name in CASES:
        (out / f"{name}.webp").write_bytes(web.encode_webp(draw_case(name)))


def draw_case(name: str) -> Array:
    """Return a case's three photographs side by side, from short to long."""
    scene, happens = CASES[name]
    frames = happens(np.asarray(getattr(scenes, scene)(SHAPE), np.float32))
    return np.hstack([np.pad(Z, ((0, 0), (3, 3), (0, 0)), constant_values=255) for Z in frames])


if __name__ == "__main__":
    main()
