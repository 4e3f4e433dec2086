"""What a place consists of, for `scenes.render` to make a picture of.

A material is a Mitsuba BSDF as a dictionary, in which an array (h, w, 3) stands for a texture of
reflectance. Light adds up, so a place is rendered once per Light, and the results are summed. Each
Light then needs only what matters to it.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from scenes.models.shapes import Parts

Colour = tuple[float, float, float]
Material = dict[str, Any]
Texture = NDArray[np.floating[Any]]


class Light(NamedTuple):
    """A kind of light in a place.

    Attributes
    ----------
    glow : radiance, cd/m^2, of what shines, by material: (r, g, b), or a texture over uv from 0 to
        1, each
        place of which belongs to one place of each part of that material
    beams : further emitters, as Mitsuba's dictionaries
    absent : materials that are not there, as they would be in the way
    black : materials that return no light
    hidden : True where what shines is not itself seen by the camera
    bounces : how often light is followed from one surface to the next
    parts : what is there in this light alone
    share : of the paths that are followed for a light, the part that this one needs
    detailed : True where it varies over a pixel or two, as it does among leaves
    """

    glow: Mapping[str, Colour | Texture | Material] = {}
    beams: tuple[Material, ...] = ()
    absent: tuple[str, ...] = ()
    black: tuple[str, ...] = ()
    hidden: bool = False
    bounces: int = 6
    parts: Parts = []
    share: float = 1.0
    detailed: bool = False


class Camera(NamedTuple):
    """Where the camera stands and looks, metres, and its angle of view from left to right, degrees."""

    origin: Colour
    target: Colour
    angle: float


class Place(NamedTuple):
    """A model, its materials, its lights by name, the camera, and a visitor who is not always there."""

    parts: Parts
    materials: dict[str, Material]
    lights: dict[str, Light]
    camera: Camera
    visitor: Parts
