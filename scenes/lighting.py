"""A place in its lights, each rendered by itself: what shines, and what it gives to what is seen.

E      radiance (H, W, 3), cd/m^2
rho    reflectance (H, W, 3)
"""

import tempfile
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from scenes.denoise import DARKEST, denoise, finer
from scenes.models.place import Light, Place
from scenes.models.shapes import Parts
from scenes.relay import relayed
from scenes.tracer import Float, Frame, Guides, halved, scene, seen, sensor, sharp, stacked, traced

SMOOTH = 144  # samples per pixel, at most, of what has but its edges to smooth


def shining(
    mi: ModuleType, place: Place, parts: Parts, light: Light, frame: Frame, samples: int, seed: int
) -> Float:
    """Return E of what shines into the camera, and of what a projector lights: no path of it is chance."""
    if light.hidden:
        rows, columns = (len(range(n)[part]) for n, part in zip(frame[:2], frame[2:], strict=True))
        return np.zeros((rows, columns, 3), np.float32)
    lengths = 2 if light.bounces == 1 else 1
    path = {"type": "path", "max_depth": lengths, "hide_emitters": light.hidden}
    with tempfile.TemporaryDirectory() as folder:
        made = scene(mi, place, parts, light, Path(folder), sensor(mi, place.camera, frame))
        return sharp(mi, made, place.camera, frame, path, min(samples, SMOOTH), seed)


def scattered(
    mi: ModuleType,
    place: Place,
    parts: Parts,
    light: Light,
    frame: Frame,
    known: Guides,
    samples: int,
    seed: int,
) -> Float:
    """Return the light on what is seen, E over rho, (H, W, 3), without the noise of its paths."""
    path = {"type": "path", "max_depth": light.bounces + 1, "hide_emitters": True, "rr_depth": 3}
    half = max(round(samples * light.share / 2), 1)
    with tempfile.TemporaryDirectory() as folder:
        made = scene(mi, place, parts, light, Path(folder), sensor(mi, place.camera, frame))
        A, B = (traced(mi, made, path, half, each) for each in (seed, seed + 1_000_003))
    return denoise(A, B, known.rho, stacked(known), radius=5 if light.detailed else 10)


def lit(
    mi: ModuleType,
    place: Place,
    parts: Parts,
    light: Light,
    frame: Frame,
    known: tuple[Guides, Guides],
    samples: int,
    seed: int,
) -> Float:
    """Return E of a place in one light; `known` is what is seen in the frame, and in one half as fine.

    Light varies less than the surface that it falls on: what other surfaces and lights of some size
    give is found on the coarser grid, unless it is detailed.
    """
    E = shining(mi, place, parts, light, frame, samples, seed)
    if light.bounces == 1:
        return E
    fine, blunt = known
    if light.detailed:
        light_on = scattered(mi, place, parts, light, frame, fine, samples, seed)
    else:
        coarse = scattered(mi, place, parts, light, halved(frame), blunt, samples, seed)
        light_on = finer(coarse, stacked(blunt)[..., :4], stacked(fine)[..., :4])
    return E + np.maximum(fine.rho, np.float32(DARKEST)) * light_on


def radiance(
    mi: ModuleType, place: Place, parts: Parts, frame: Frame, samples: int, seed: int
) -> Float:
    """Return E of a frame, the sum over all lights."""
    known: dict[tuple[str, ...], tuple[Guides, Guides]] = {}
    views = (frame, halved(frame))
    smooth = min(samples, SMOOTH)
    E: Any = 0.0
    for k, light in enumerate(relayed(mi, place).values()):
        if light.absent not in known:
            fine, blunt = (seen(mi, place, parts, light, view, smooth, seed) for view in views)
            known[light.absent] = fine, blunt
        E = E + lit(
            mi, place, parts, light, frame, known[light.absent], samples, seed + 7919 * (k + 1)
        )
    return E
