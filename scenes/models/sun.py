"""Sunlight through a pane: as if a projector stood where the sun does, with the pane for its slide.

The sun's disc is half a degree wide, so that every edge in the slide blurs with the distance it
falls.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import gaussian_filter, map_coordinates

from scenes.models.place import Material
from scenes.models.shapes import unit

Float = NDArray[np.float64]
FAR = 400.0  # metres: its rays part by a thousandth over a window
BLUR = 0.0093 / 4 * 6.0  # metres, standard deviation of the sun's disc, seen 6 m behind a pane


def through(
    T: Float,
    corner: ArrayLike,
    along: ArrayLike,
    up: ArrayLike,
    sun: ArrayLike,
    light: ArrayLike,
    *,
    texels: int = 384,
) -> Material:
    """Return Mitsuba's emitter of the sunlight through a pane.

    Parameters
    ----------
    T : (h, w, 3), transmittance, rows running downwards
    corner : (3,), metres, the lower left corner of the pane, as the one sees it who looks at T
    along, up : (3,), metres, its lower and its left side
    sun : (3,), the direction towards the sun, which does not stand in the zenith
    light : (3,), illuminance of a surface that faces the sun
    """
    corner, along, up, sun = (
        np.asarray(v, np.float64) for v in (corner, along, up, unit(np.asarray(sun, float)))
    )
    middle = corner + (along + up) / 2
    eye = middle + FAR * sun
    # The axes of the projector's picture: it looks along -sun; x to its left, as Mitsuba's cameras
    # have it.
    left = unit(np.cross([0.0, 1.0, 0.0], -sun))
    top = np.cross(-sun, left)
    half = 0.55 * np.linalg.norm([np.linalg.norm(along), np.linalg.norm(up)])
    s = (np.arange(texels) + 0.5) / texels * 2 - 1
    x, y = np.meshgrid(-s * half, -s * half)  # first row on top, first column on the left
    ray = x[..., None] * left + y[..., None] * top - FAR * sun
    normal = np.cross(along, up)
    t = ((middle - eye) @ normal) / (ray @ normal)
    hit = eye + t[..., None] * ray - corner
    u = hit @ along / (along @ along)
    v = hit @ up / (up @ up)
    at = np.stack([(1 - v) * T.shape[0] - 0.5, u * T.shape[1] - 0.5])
    inside = (u >= 0) & (u <= 1) & (v >= 0) & (v <= 1)
    slide = np.stack(
        [inside * map_coordinates(T[..., c], at, order=1, mode="nearest") for c in range(3)], axis=2
    )
    slide = np.stack(
        [gaussian_filter(slide[..., c], BLUR * texels / (2 * half)) for c in range(3)], axis=2
    )
    angle = 2 * np.degrees(np.arctan(half / FAR))
    return {
        "type": "projector",
        "irradiance": slide
        * np.asarray(light, float)
        * FAR**2
        / np.pi,  # Mitsuba multiplies it by pi
        "fov": float(angle),
        "look_at": {"origin": eye.tolist(), "target": middle.tolist(), "up": [0, 1, 0]},
    }
