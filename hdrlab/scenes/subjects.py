"""Three subjects that mislead a meter: against the light, in snow, and black (Battiato et al., sec. 1.2).

E     radiance     (H, W, 3) float32, cd/m^2
mask  (H, W) bool, the pixels of the subject
rho   reflectance  of the subject: where its brightness belongs, 0.18 for a gray card

They were computed before, by `scenes/computed`, and are read from OpenEXR files beside this one.
"""

from typing import NamedTuple

from hdrlab.core.arrays import F32, Mask
from hdrlab.core.colour import luminance
from hdrlab.io.maps.layers import read_layers
from hdrlab.scenes.places import FOLDER, Shape, resample

SHAPE = (256, 384)
# cd/m^2 of a white sheet in the subject's place
LIGHT = {"backlight": 500.0, "snow": 8000.0, "locomotive": 3000.0}


class Subject(NamedTuple):
    """A scene with the subject that its photographer meant."""

    E: F32
    mask: Mask
    rho: float


def backlight(shape: Shape = SHAPE) -> Subject:
    """Return a woman before a bright evening sky: her face, in the shade, is four stops below it.

    The face is the astronaut's, of scikit-image; a white sheet in her place has 500 cd/m^2.
    """
    return _read("backlight", shape)


def snow(shape: Shape = SHAPE) -> Subject:
    """Return a snow field in the sun, with a hut far away: most of it reflects 86 % of the light."""
    return _read("snow", shape)


def locomotive(shape: Shape = SHAPE) -> Subject:
    """Return a black locomotive, which fills the picture and reflects a twentieth of a dull day's light."""
    return _read("locomotive", shape)


SUBJECTS = {"backlight": backlight, "snow": snow, "locomotive": locomotive}


def _read(name: str, shape: Shape) -> Subject:
    """Return a Subject, with the pixels that it covers completely as its mask."""
    picture = resample(read_layers(FOLDER / f"{name}.exr")["subject"], shape)
    E = picture[..., :3]
    mask = picture[..., 3] > 0.99
    return Subject(E, mask, float(luminance(E)[mask].mean()) / LIGHT[name] if mask.any() else 0.0)
