"""The light that falls on a matt surface, in closed form.

P     points (3, N) on a plane square to an axis, metres
face  that plane: 2 * axis, and 1 more where the normal looks back along the axis: n = +e_axis or -e_axis
F     the share (N,) of a source's radiance L that counts there: its illuminance is pi F L, and a surface of
      reflectance rho returns rho F L
"""

from typing import NamedTuple

import numpy as np

from scenes.computed.textures import Points, rgb


class Box(NamedTuple):
    """A box square to the axes: two opposite corners, (x, y, z) in metres."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]


def facing(v: Points, face: int) -> Points:
    """Return v . n of the normal of `face`."""
    return v[face // 2] * (1 - 2 * (face % 2))


def length(v: Points) -> Points:
    """Return |v| of each column."""
    return np.sqrt(np.einsum("in,in->n", v, v))


def from_window(P: Points, face: int, window: Box) -> Points:
    """Return F of an evenly bright rectangle, the near side of `window`.

    F = sum theta n.(a x b) / |a x b| / 2 pi over its edges, with a and b the sights of an edge's
    ends and theta the angle between them [Lambert, Photometria, 1760].
    """
    (x0, y0, z), (x1, y1, _) = window
    corners = [rgb(*corner) - P for corner in ((x0, y0, z), (x0, y1, z), (x1, y1, z), (x1, y0, z))]
    sights = [corner / length(corner) for corner in corners]
    i = face // 2
    j = (face // 2 + 1) % 3
    k = (face // 2 + 2) % 3
    F = np.zeros_like(P[i])
    for a, b in zip(sights, sights[1:] + sights[:1], strict=True):
        cos = np.clip(
            np.einsum("in,in->n", a, b), -1 + 1e-6, 1 - 1e-6
        )  # edge-on, theta / sin theta is 0 / 0
        F += np.arccos(cos) / np.sqrt(1 - cos * cos) * (a[j] * b[k] - a[k] * b[j])
    return np.abs(F) / np.float32(2 * np.pi)


def from_globe(P: Points, face: int, centre: Points, radius: float) -> Points:
    """Return F = cos radius^2 / |v|^2 of a bright sphere, with v the sight of its centre.

    Examples
    --------
    >>> lamp = np.array([[0.0], [0.0], [2.0]])
    >>> float(from_globe(0 * lamp, 4, lamp, 0.5)[0])  # (radius / distance)^2, straight ahead
    0.0625
    """
    v = centre - P
    return np.maximum(facing(v, face), 0) * radius**2 / length(v) ** 3


def from_walls(P: Points, box: Box) -> Points:
    """Return the share of their own light that the walls of a box receive: 1 amid a wall, less in corners."""
    F = np.ones_like(P[0])
    for p, low, high in zip(P, box.low, box.high, strict=True):
        F *= 1 - 0.45 * np.exp(np.minimum(p - low, high - p) / np.float32(-0.35))
    return F / np.float32(0.55)  # the wall itself is at distance 0
