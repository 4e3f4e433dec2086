"""Render a place again: `python -m scenes.render chapel -o chapel.exr`.

Mitsuba 3 traces the paths (`pip install "hdrlab[scenes]"`), and is needed for nothing else. A place
is rendered once per light, in two halves whose difference tells the noise, which `scenes.denoise`
takes out.

E      radiance (H, W, 3), cd/m^2
"""

import argparse
import sys
import tempfile
from collections.abc import Iterable
from functools import lru_cache
from importlib import import_module
from pathlib import Path
from types import ModuleType

import numpy as np
from scipy.ndimage import gaussian_filter

from hdrlab.cli.terminal import elapsed
from hdrlab.core.colour import luminance
from hdrlab.io.maps.exr import LARGEST_HALF
from hdrlab.scenes.places import PLACES
from scenes.files import write_layers
from scenes.lighting import SMOOTH, radiance
from scenes.models.place import Light, Place
from scenes.tracer import Float, Frame, mitsuba, scene, sensor, sharp

FAR = 1000.0  # metres: where a line of sight meets nothing
APART = 10_000_019  # between the seeds of two rounds: passes and lights count on from theirs
DIMMEST = 2.0**-14  # cd/m^2, the smallest half float of full precision


@lru_cache(maxsize=len(PLACES))
def model(name: str) -> Place:
    """Return the model of a place."""
    if name not in PLACES:
        raise ValueError(f"expected one of {', '.join(PLACES)}, got {name!r}")
    place: Place = import_module(f"scenes.models.{name}").place()
    return place


def depth(mi: ModuleType, place: Place, frame: Frame) -> Float:
    """Return metres along the camera's axis, (H, W): one line of sight a pixel, as edges have no mean."""
    with tempfile.TemporaryDirectory() as folder:
        first = next(iter(place.lights.values()))
        made = scene(mi, place, place.parts, first, Path(folder), sensor(mi, place.camera, frame))
        distance = mi.load_dict({"type": "aov", "aovs": "t:depth"})
        t = np.array(mi.render(made, integrator=distance, spp=1, seed=0))[..., -1]
    pixel = 2 * np.tan(np.radians(place.camera.angle) / 2) / frame.width
    rows, columns = (pixel * (np.arange(n) + 0.5 - n / 2) for n in (frame.height, frame.width))
    z = t / np.sqrt(1 + rows[frame.rows, None] ** 2 + columns[frame.columns] ** 2)
    return np.where(t > 0, z, FAR).astype(np.float32)


def cover(mi: ModuleType, place: Place, frame: Frame) -> Float:
    """Return the share of each pixel that the visitor hides, (H, W): all is black, and he alone shines."""
    visitor = [("visitor", mesh) for _, mesh in place.visitor]
    white = Light({"visitor": (1.0, 1.0, 1.0)}, black=tuple(place.materials))
    with tempfile.TemporaryDirectory() as folder:
        made = scene(
            mi, place, place.parts + visitor, white, Path(folder), sensor(mi, place.camera, frame)
        )
        return sharp(mi, made, place.camera, frame, {"type": "path", "max_depth": 1}, SMOOTH, 5)[
            ..., 0
        ]


def around(mask: Float) -> tuple[slice, slice]:
    """Return the rectangle around a mask with a margin for shadows, its corners at even places."""
    spans = []
    margin = len(mask) // 5
    for axis in (0, 1):
        at = np.flatnonzero(mask.any(axis=1 - axis))
        low = max(int(at[0]) - margin, 0)
        high = min(int(at[-1]) + 1 + margin, mask.shape[axis])
        spans.append(slice(low // 2 * 2, high // 2 * 2))
    return spans[0], spans[1]


def visitor(E: Float, without: Float, hidden: Float) -> Float:
    """Return the visitor's layer (H, W, 4): radiance times mask, and the mask of what he hides or shades.

    The place with him is E = mover + (1 - mask) without. So what he hides is E - (1 - hidden)
    without, and a surface in his shade counts as hidden by something black, in the share of its
    light that it has lost.
    """
    c = hidden[..., None]
    body = np.clip(E - (1 - c) * without, 0, None) * (c > 0)
    clear = (1 - hidden) * (hidden < 0.5)
    lights = [gaussian_filter(clear * luminance(each), 2.0) + 1e-9 for each in (E, without)]
    shade = np.clip(1 - lights[0] / lights[1] - 0.04, 0, 1) * (hidden == 0)
    return np.dstack([body, hidden + (1 - hidden) * shade]).astype(np.float32)


def once(name: str, *, height: int, samples: int, seed: int, variant: str) -> dict[str, Float]:
    """Return the layers of a place, rendered once; see `rendered`."""
    mi = mitsuba(variant)
    place = model(name)
    frame = Frame(height, height * 3 // 2)
    E = radiance(mi, place, place.parts, frame, samples, seed)
    hidden = cover(mi, place, frame)
    part = around(hidden)
    cut = frame._replace(rows=part[0], columns=part[1])
    visited = radiance(mi, place, place.parts + place.visitor, cut, samples, seed)
    mover = np.zeros((*hidden.shape, 4), np.float32)
    mover[part] = visitor(visited, E[part], hidden[part])
    return {"radiance": E, "depth": depth(mi, place, frame), "mover": mover}


def mean(rounds: Iterable[dict[str, Float]]) -> dict[str, Float]:
    """Return the mean of layers that were rendered several times, as half floats can hold it."""
    every = list(rounds)
    layers = {key: np.mean([each[key] for each in every], axis=0) for key in every[0]}
    layers["radiance"] = np.maximum(layers["radiance"], DIMMEST)
    return {key: np.minimum(layer, np.float32(LARGEST_HALF)) for key, layer in layers.items()}


def rendered(
    name: str,
    *,
    height: int = 512,
    samples: int = 320,
    rounds: int = 4,
    seed: int = 0,
    variant: str = "scalar_rgb",
) -> dict[str, Float]:
    """Return the layers of a place: radiance (H, W, 3), depth (H, W) and mover (H, W, 4).

    Parameters
    ----------
    name : "chapel", "workshop" or "street"
    height : of the picture in pixels, which 4 divides; its width is 3 / 2 of it
    samples : paths per pixel of the coarser grid, in each light and round
    rounds : how often it is rendered, each time with other paths; the result is the mean
    seed : of the paths
    variant : of Mitsuba; "llvm_ad_rgb" is quicker where the machine has LLVM, and its results are
        equal

    Raises
    ------
    ModuleNotFoundError
        Where Mitsuba is not installed.
    ValueError
        For another name, a height that is below 32 or that 4 does not divide, or no round at all.
    """
    if height < 32 or height % 4:
        raise ValueError(f"expected a height of at least 32 pixels that 4 divides, got {height}")
    if rounds < 1:
        raise ValueError(f"expected at least one round, got {rounds}")
    return mean(
        once(name, height=height, samples=samples, seed=seed + k * APART, variant=variant)
        for k in range(rounds)
    )


def main() -> None:
    """Render what the command line asks for."""
    parser = argparse.ArgumentParser(
        prog="python -m scenes.render", description="Render a place again."
    )
    parser.add_argument("name", choices=PLACES)
    parser.add_argument("-o", "--out", type=Path, help="an .exr file; NAME.exr, unless told")
    parser.add_argument(
        "--height", type=int, default=512, help="of the picture, pixels (default: 512)"
    )
    parser.add_argument(
        "--samples", type=int, default=320, help="paths per pixel and light (default: 320)"
    )
    parser.add_argument(
        "--rounds", type=int, default=4, help="of which the mean is taken (default: 4)"
    )
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--variant", default="scalar_rgb", help="of Mitsuba; llvm_ad_rgb is quicker where LLVM is"
    )
    knobs = vars(parser.parse_args())
    name = knobs.pop("name")
    out = knobs.pop("out")
    try:
        with elapsed(f"rendering the {name}"):
            layers = rendered(name, **knobs)
        write_layers(out or Path(f"{name}.exr"), layers)
    except (ImportError, OSError, ValueError) as error:
        sys.exit(f"error: {error}")


if __name__ == "__main__":
    main()
