"""Surfaces with detail: pictures that travel in scikit-image's wheel, read at any scale without aliasing.

rho   reflectance (C, N), 0 to 1; C = 1 gray or 3 RGB
u, v  places (N,) on a texture, to the right and down, 1 = its whole side; beyond its sides it is mirrored
w     width (N,) that a pixel covers there, in the unit of what is measured

The wheel holds astronaut, brick, chelsea, coffee, grass and gravel, free of rights: nothing is
downloaded.
"""

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from hdrlab.core.colour import decode_srgb
from hdrlab.core.optional import skimage_data as data, skimage_transform as transform

Points = NDArray[np.floating[Any]]


def rgb(r: float, g: float, b: float) -> Points:
    """Return a colour as a column (3, 1), to meet the points (3, N) of a surface."""
    return np.array([[r], [g], [b]], np.float32)


def straighten(picture: Points) -> Points:
    """Return the brick wall, which was photographed from below, with its courses parallel."""
    row, column = np.mgrid[: picture.shape[0], : picture.shape[1]]
    narrowing = 0.79 + 0.21 * row / picture.shape[0]
    middle = 0.47 * picture.shape[1]
    return map_coordinates(picture[..., 0], [row, middle + (column - middle) * narrowing], order=1)[
        ..., None
    ]


@lru_cache(maxsize=16)
def texture(name: str) -> tuple[Points, ...]:
    """Return the reflectance of a picture, (h, w, C), and its halvings to one texel [Williams83 sec. 2]."""
    picture: Points = np.atleast_3d(getattr(data, name)()) / np.float32(255)
    if name == "brick":
        picture = straighten(picture)
    rho = 0.02 + 0.9 * decode_srgb(picture)  # no paint is quite black, and none quite white
    return tuple(
        level.astype(np.float32) for level in transform.pyramid_gaussian(rho, channel_axis=-1)
    )


def look_up(name: str, u: Points, v: Points, w: Points) -> Points:
    """Return rho at (u, v), read between the two halvings whose texels are nearest in size to w."""
    levels = texture(name)
    k = np.clip(np.log2(w * max(levels[0].shape)), 0, len(levels) - 1)
    rho = np.zeros((levels[0].shape[-1], len(u)), np.float32)
    for size, level in enumerate(levels):
        share = 1 - np.abs(k - size)
        at = np.flatnonzero(share > 0)
        if len(at):
            texel = [v[at] * level.shape[0] - 0.5, u[at] * level.shape[1] - 0.5]
            for c in range(len(rho)):
                rho[c, at] += share[at] * map_coordinates(
                    level[..., c], texel, order=1, mode="reflect"
                )
    return rho


def cover(below: Points, share: Points, above: Points | float) -> Points:
    """Return one surface over another, of which it hides a share of 0 to 1 [Porter84 sec. 4].

    Examples
    --------
    >>> cover(np.array([[0.2]]), np.array([0.25]), 1.0).tolist()
    [[0.4]]
    """
    return below + share * (above - below)


def within(distance: Points, w: Points | float) -> Points:
    """Return the share of a pixel w wide inside an edge, its centre `distance` from it; below 0 outside."""
    s = np.clip(distance / w + 0.5, 0, 1)
    return s * s * (3 - 2 * s)
