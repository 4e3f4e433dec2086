"""Real brackets from the hand: is the map as sharp as the sharpest of its photographs?

S  sharpness  the slope that one pixel in a hundred exceeds, stops per pixel: an edge that is out of place by
              a pixel in one photograph of the bracket becomes two gentler ones in the map

Map and photographs are compared over the same pixels: those which the photograph in the middle,
which is never resampled, measures well, too. A photograph is moved to the nearest pixel for that;
nothing is smoothed.

Read the arch with care: its photographs lie within a few pixels of each other, and where they do
not agree the map has steps that no photograph has. These count as sharp, too, so there is no hold
on it.
"""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from scipy.ndimage import binary_erosion

from benchmarks.experiments import Experiment, at_least, real
from hdrlab import pipeline
from hdrlab.align import light
from hdrlab.align.mtb import by_brightness
from hdrlab.core.arrays import Array, ArrayLike, NDArray
from hdrlab.core.bracket import Bracket, bracket
from hdrlab.core.colour import decode_srgb
from hdrlab.core.filters import warp
from hdrlab.io.album import photographs
from hdrlab.io.photos import read_bracket, read_photo

WELL = (30, 225)  # levels between which a photograph shows an edge as it is
# fraction of the pixels that two photos must measure well to be compared
MIN_MEASURED_FRACTION = 0.02
HALF = 2  # the photographs are halved: the light of each 2 x 2 pixels


def arch(folder: Path) -> Bracket:
    """Return the St. Louis arch: 4 photographs, shifts of up to 8 pixels, and water that moves."""
    taken = read_bracket(real(folder, "stlouis_arch"))
    return replace(taken, images=smaller(taken.images))


def crusader(folder: Path) -> Bracket:
    """Return the crusader: 7 photographs of a walk around it. Their times are not known.

    So they are those that the histograms of neighbours in brightness tell by the curve of sRGB.
    """
    paths = photographs(real(folder, "crusader") / "frames")
    images = smaller(np.stack([read_photo(path) for path in paths]))
    order = by_brightness(images)
    g = np.log(np.maximum(decode_srgb(np.arange(256) / 255), 1e-4))
    steps = [
        light.exposure_ratio(images[a, ..., 1], images[b, ..., 1], g)
        for a, b in zip(order, order[1:], strict=False)
    ]
    return bracket(images[order], np.cumprod([1.0, *steps]), [paths[j].name for j in order])


def smaller(images: Array) -> Array:
    """Return photographs at half the size."""
    n = images.shape[0]
    h = images.shape[1] // HALF
    w = images.shape[2] // HALF
    blocks = images[:, : HALF * h, : HALF * w].reshape(n, h, HALF, w, HALF, 3)
    return (blocks.mean(axis=(2, 4)) + 0.5).astype(images.dtype)


def sharpness(X: Array, seen: NDArray[np.bool_]) -> float:
    """Return S of light X (h, w), of the pixels that are seen."""
    down, across = np.gradient(np.log2(np.maximum(X, 1e-12)))
    return float(np.quantile(np.hypot(down, across)[seen], 0.99))


def beside_the_sharpest(taken: Bracket, align: str) -> float:
    """Return the map's S / that of the photograph beside which it is lowest, over what both measure well."""
    assembly = pipeline.assemble(taken, align=align)
    rows, columns = warp.common_rectangle(assembly.homographies, taken.images.shape[1:3])
    size = (rows.stop - rows.start, columns.stop - columns.start)
    first = [[rows.start, columns.start]]
    back = np.linalg.inv(assembly.homographies) @ warp.as_homographies(first)
    Z = [
        warp.nearest(frame[..., 1].astype(float), H, size)
        for frame, H in zip(taken.images, back, strict=True)
    ]
    g = assembly.g if assembly.g.ndim == 1 else assembly.g[:, 1]
    own = by_brightness(taken.images)[len(Z) // 2 - 1 + len(Z) % 2]
    well = [binary_erosion((frame > WELL[0]) & (frame < WELL[1]), iterations=2) for frame in Z]
    shares = []
    for frame, seen in zip(Z, well, strict=True):
        both = seen & well[own]
        if both.mean() > MIN_MEASURED_FRACTION:
            shares.append(
                sharpness(assembly.E[..., 1], both) / sharpness(np.exp(g[frame.astype(int)]), both)
            )
    return min(shares)


def compared(folder: Path, *, which: str) -> Mapping[str, ArrayLike]:
    """Return the sharpness of the map beside its sharpest photograph, for each way to align."""
    taken = {"arch": arch, "crusader": crusader}[which](folder)
    errors = {
        way: beside_the_sharpest(taken, way)
        for way in ("none", "mtb", "cerman", "homography", "auto")
    }
    return errors | {GAIN: max(errors[way] for way in errors if way != "none") / errors["none"]}


GAIN = "the sharpest of the others / none"
TITLE = "sharpness of the map / that of its sharpest photograph, for each way to align"
ROWS = tuple(
    Experiment(f"align-{which}", f"{TITLE}; {which}", partial(compared, which=which), holds)
    for which, holds in (
        ("arch", ()),
        ("crusader", (at_least(GAIN, 1.2),)),
    )
)
