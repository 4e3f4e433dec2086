"""Veiling glare of lenses that are not known: what of the truth comes back, and that clear ones stay alone.

Four scenes through lenses that scatter 5 or 10 % of the light with the power 2, 2.5 or 3 of the
distance. The affected region is where more than 5 % of a pixel's light was scattered, in a channel;
its error there is that of E over the truth, the largest of the channels. "photographed" has ten
frames of 8 bits between lens and map, two stops apart, the shortest of which holds the brightest
light; its error counts where a frame measured the pixel, with what the merge errs in it. A light
that all frames clip scatters more than the map knows of.
"""

from collections.abc import Callable, Mapping
from itertools import product
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.experiments import Experiment, along, at_least, at_most
from benchmarks.ghosts.sequences import CAMERA, SHAPE, STILL, radiance
from hdrlab.capture import camera
from hdrlab.capture.lens_flare import add_glare
from hdrlab.capture.responses import true_g
from hdrlab.core import weights
from hdrlab.core.arrays import Array, ArrayLike
from hdrlab.core.filters.scatter import GlareSpread
from hdrlab.radiance import flare
from hdrlab.radiance.merge import merge_with_quality
from hdrlab.scenes.places import resample

LENSES = tuple(GlareSpread(share, power) for share, power in product((0.05, 0.1), (2.0, 2.5, 3.0)))
AFFECTED = 0.05  # of a pixel's light
CLOSE = 0.05  # of the truth


class Left(NamedTuple):
    """Errors in the affected region: median before and after, and the share of pixels within 5 %."""

    before: float
    after: float
    close: float


def left(E: Array, F: Array, corrected: Array, where: Array, lens: GlareSpread) -> Left:
    """Return what is Left of a veil, where the scene had radiance E and the map F."""
    region = (1 - (1 - lens.share) * E / F).max(axis=-1) > AFFECTED
    before = np.abs(F / E - 1).max(axis=-1)[region & where]
    after = np.abs(corrected / E - 1).max(axis=-1)[region & where]
    return Left(float(np.median(before)), float(np.median(after)), float(np.mean(after < CLOSE)))


def exact(item: tuple[str, GlareSpread]) -> Left:
    """Return what is left where the map is that of the lens itself."""
    place, lens = item
    E = resample(radiance(place), SHAPE)
    F = add_glare(E, lens)
    return left(E, F, flare.remove_glare(F).E, np.ones(SHAPE, bool), lens)


def photographed(item: tuple[str, GlareSpread]) -> Left:
    """Return what is left where the map was merged from photographs."""
    place, lens = item
    E = resample(radiance(place), SHAPE)
    F, seen = through(add_glare(E, lens))
    return left(E, F, flare.remove_glare(F).E, seen == 0, lens)


def through(F: Array) -> tuple[Array, Array]:
    """Return a scene as ten photographs show it, in its own unit, and how each pixel is known."""
    times = 0.9 / F.max() * 4.0 ** np.arange(10)
    taken = camera.shoot(F, times, CAMERA, rng=1)
    merged = merge_with_quality(taken.images, taken.times, true_g("film"), weights.gaussian())
    return merged.E * np.median(F / merged.E), merged.quality


def figures(what: str, work: Callable[[tuple[str, GlareSpread]], Left]) -> Mapping[str, ArrayLike]:
    """Return the figures of all scenes and lenses."""
    items = list(product(STILL, LENSES))
    results = along(work, items, f"flare, {what}")
    out: dict[str, ArrayLike] = {}
    for place in STILL:
        own = [result for (name, _), result in zip(items, results, strict=True) if name == place]
        out[f"{place}: worst median before, after"] = tuple(
            max(result[k] for result in own) for k in (0, 1)
        )
    out["worst median error"] = max(result.after for result in results)
    out["least share of pixels within 5 %"] = min(result.close for result in results)
    out["median share of pixels within 5 %"] = float(
        np.median([result.close for result in results])
    )
    return out


def veils(_: Path) -> Mapping[str, ArrayLike]:
    """Return the figures of maps."""
    return figures("maps", exact)


def bracketed(_: Path) -> Mapping[str, ArrayLike]:
    """Return the figures of maps that were merged from photographs."""
    return figures("photographs", photographed)


def clear(_: Path) -> Mapping[str, ArrayLike]:
    """Return how much is changed in what a clear lens shows, of maps and of merged photographs."""
    changes = []
    for place in STILL:
        E = resample(radiance(place), SHAPE)
        changes += [
            float(np.abs(flare.remove_glare(F).E / F - 1).max()) for F in (E, through(E)[0])
        ]
    return {"maps looked at": len(changes), "most change": max(changes)}


ROWS = (
    Experiment(
        "flare",
        "four scenes, six lenses: error where more than 5 % of the light was scattered",
        veils,
        (at_most("worst median error", 0.05), at_least("least share of pixels within 5 %", 0.85)),
    ),
    Experiment(
        "flare-photographed",
        "the same from ten photographs of 8 bits",
        bracketed,
        (at_most("worst median error", 0.05),),
    ),
    Experiment(
        "flare-clear", "the same scenes through a clear lens", clear, (at_most("most change", 0),)
    ),
)
