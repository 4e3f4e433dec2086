"""The places that travel with the package: a chapel, a workshop, a street at night, and a room with a window.

E      radiance (H, W, 3) float32, cd/m^2, primaries of sRGB
depth  (H, W) float32, metres from the camera along its axis
mover  radiance (H, W, 3) of a visitor, cd/m^2, already multiplied by the mask
mask   (H, W) float32, the share of a pixel that the visitor hides, 0 to 1

They were rendered by `scenes.render` out of `scenes.models`, the room by `scenes.computed`, and are
read from OpenEXR files.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from hdrlab.capture.movers import Figure, compose_moment
from hdrlab.core.arrays import F32, F64, ArrayLike, describe
from hdrlab.errors import InputError
from hdrlab.io.maps.layers import read_layers

Shape = tuple[int, int]
FOLDER = Path(__file__).parent
PLACES = ("chapel", "workshop", "street")


class Layers(NamedTuple):
    """A place, and a visitor who is not in it yet.

    Attributes
    ----------
    radiance : (H, W, 3), cd/m^2, of the place without the visitor
    depth : (H, W), metres along the camera's axis
    mover : (H, W, 3), cd/m^2, radiance of the visitor times `mask`
    mask : (H, W), share of a pixel that the visitor hides or shades, 0 to 1
    """

    radiance: F32
    depth: F32
    mover: F32
    mask: F32


def chapel(shape: Shape | None = None) -> F32:
    """Return the radiance of a dark chapel: stained glass with the sun behind it, candles, and pews.

    Parameters
    ----------
    shape : (H, W), pixels, at most 512 x 768, which is the default; see `layers`

    Returns
    -------
    E : (H, W, 3) float32, cd/m^2, positive everywhere

    Raises
    ------
    ValueError
        For a shape that is not two numbers from 1 to the size of the scene.

    Examples
    --------
    >>> chapel((64, 96)).shape
    (64, 96, 3)
    """
    return layers("chapel", shape).radiance


def workshop(shape: Shape | None = None) -> F32:
    """Return the radiance of a workshop: a bench and its tools, before a window on a sunny yard.

    Parameters, what is returned and what is raised are those of `chapel`.

    Examples
    --------
    >>> workshop((64, 96)).shape
    (64, 96, 3)
    """
    return layers("workshop", shape).radiance


def street(shape: Shape | None = None) -> F32:
    """Return the radiance of a street at night: lamps, lit windows, wet stones, and an alley without a light.

    Parameters, what is returned and what is raised are those of `chapel`.

    Examples
    --------
    >>> street((64, 96)).shape
    (64, 96, 3)
    """
    return layers("street", shape).radiance


def room(shape: Shape | None = None) -> F32:
    """Return the radiance of a room by day: the sun in its window, a lamp, and an unlit room behind a door.

    Parameters, what is returned and what is raised are those of `chapel`.

    Examples
    --------
    >>> room((64, 96)).shape
    (64, 96, 3)
    """
    E = read_layers(FOLDER / "room.exr")["radiance"]
    return resample(E, E.shape[:2] if shape is None else shape)


def layers(name: str, shape: Shape | None = None) -> Layers:
    """Return a place with its depth and its visitor.

    A smaller shape is averaged over areas, in linear light, as a coarser sensor behind the same
    lens would see it. Where its sides have another ratio, two edges are cut off: pixels stay
    square.

    Parameters
    ----------
    name : "chapel", "workshop" or "street"
    shape : (H, W), pixels, at most the scene's own size, which is the default

    Returns
    -------
    Layers, of that shape

    Raises
    ------
    ValueError
        For another name, or a shape that is not two numbers from 1 to the size of the scene.

    Examples
    --------
    >>> layers("street", (64, 96)).depth.shape
    (64, 96)
    """
    if name not in PLACES:
        raise InputError(f"expected one of {', '.join(PLACES)}, got {name!r}")
    read = read_layers(FOLDER / f"{name}.exr")
    visitor = read["mover"]
    if shape is None:
        shape = read["depth"].shape
    return Layers(
        radiance=resample(read["radiance"], shape),
        depth=resample(read["depth"], shape),
        mover=resample(visitor[..., :3], shape),
        mask=resample(visitor[..., 3], shape),
    )


def compose(place: Layers, offset: ArrayLike = (0, 0)) -> F32:
    """Return E = mover + (1 - mask) radiance, the place with its visitor [Porter84 sec. 4].

    Parameters
    ----------
    place : Layers
    offset : (dy, dx) whole pixels, by which the visitor is moved down and to the right; parts
        outside of the frame are cut off

    Returns
    -------
    E : (H, W, 3) float32, cd/m^2

    Raises
    ------
    ValueError
        For an offset that is not two whole numbers.

    Examples
    --------
    Three photographs of a street, while somebody walks through it:

    >>> from hdrlab.capture.camera import shoot
    >>> street = layers("street", (64, 96))
    >>> moments = [shoot(compose(street, (0, dx)), [0.1]) for dx in (-8, 0, 8)]

    References
    ----------
    Porter and Duff, Compositing digital images, SIGGRAPH 1984.
    """
    offset = np.asarray(offset)
    if offset.shape != (2,) or offset.dtype.kind not in "iu":
        raise InputError(f"expected an offset (dy, dx) of whole pixels, got {describe(offset)}")
    return compose_moment(place.radiance, Figure(place.mover, place.mask), offset)[0]


def resample(layer: F32, shape: Shape) -> F32:
    """Return the means of a layer over the areas of a coarser grid of square pixels, the largest it holds."""
    if len(shape) != 2 or any(
        not 1 <= n <= full for n, full in zip(shape, layer.shape, strict=False)
    ):
        raise InputError(f"expected a shape (H, W) from (1, 1) to {layer.shape[:2]}, got {shape}")
    pixel = min(full / n for n, full in zip(shape, layer.shape, strict=False))
    for axis, n in enumerate(shape):
        edges = (layer.shape[axis] - n * pixel) / 2 + pixel * np.arange(n + 1)
        layer = mean_between(layer, edges, axis)
    return layer


def mean_between(layer: F32, edges: F64, axis: int) -> F32:
    """Return the mean of a layer along an axis between each two edges, which may lie inside a pixel."""
    total = np.cumsum(layer, axis=axis, dtype=np.float64)
    total = np.concatenate([np.zeros_like(total.take([0], axis)), total], axis)
    whole = np.minimum(edges.astype(int), layer.shape[axis] - 1)
    share = np.expand_dims(edges - whole, [k for k in range(layer.ndim) if k != axis])
    sums = (1 - share) * total.take(whole, axis) + share * total.take(whole + 1, axis)
    means = np.diff(sums, axis=axis) / (edges[1] - edges[0])
    return np.maximum(means, 0).astype(np.float32)  # where all is 0, rounding may have left less
