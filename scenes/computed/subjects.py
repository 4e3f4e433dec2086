"""Three subjects that mislead a meter: against the light, in snow, and black (Battiato et al., sec. 1.2).

A picture is (H, W, 4): the radiance in cd/m^2, and the share of each pixel that the subject covers.

x, y  places (H, W), to the right and up, in heights of the picture, 0 in the middle
"""

import numpy as np

from hdrlab.core.arrays import F32
from hdrlab.scenes.subjects import LIGHT, SHAPE
from scenes.computed.textures import Points, cover, look_up, rgb, within


def _plane(shape: tuple[int, int]) -> tuple[Points, Points, float]:
    """Return x and y of each pixel's centre, as points (N,), and a pixel's width."""
    if len(shape) != 2 or min(shape) < 1:
        raise ValueError(f"expected a shape (H, W) of positive numbers, got {shape}")
    height, width = shape
    y, x = np.mgrid[:height, :width].astype(np.float32)
    return (
        (x.ravel() + 0.5 - width / 2) / height,
        (height / 2 - 0.5 - y.ravel()) / height,
        1 / height,
    )


def _picture(shape: tuple[int, int], E: Points, subject: Points) -> F32:
    """Return the picture of points (3, N), `subject` being the share of a pixel that it covers."""
    points = np.concatenate([E, np.broadcast_to(subject, (1, E.shape[1]))])
    return np.moveaxis(points.reshape(4, *shape), 0, -1).astype(np.float32)


def _ellipse(x: Points, y: Points, wide: float, high: float) -> Points:
    """Return the distance inward from an ellipse's edge, to first order."""
    r = np.hypot(x / wide, y / high)
    return (1 - r) * min(wide, high)


def _texels(name: str, x: Points, y: Points, pixel: float) -> Points:
    return look_up(name, x + 2, y + 2, np.full(len(x), pixel, np.float32))


def backlight(shape: tuple[int, int] = SHAPE) -> F32:
    """Return a woman before a bright evening sky: her face, in the shade, is five stops below it.

    The face is the astronaut's, of scikit-image; a white sheet in her place has 500 cd/m^2.
    """
    x, y, pixel = _plane(shape)
    shade = LIGHT["backlight"]
    sky = cover(
        rgb(1500, 2600, 4500), np.exp(np.minimum(-np.abs(y + 0.2), 0) / 0.35), rgb(7000, 6400, 5600)
    )
    hills = within(-0.18 + 0.04 * np.sin(5 * x + 1) + 0.015 * np.sin(13 * x) - y, 2 * pixel)
    E = cover(sky, hills, rgb(700, 620, 700) * (0.6 + _texels("grass", x, y, pixel)))
    # the face stands in the middle of the picture
    u = 0.44 + 0.45 * x / 1.0
    v = 0.22 - 0.45 * (y - 0.03)
    portrait = shade * look_up("astronaut", u, v, np.full(len(x), 0.45 * pixel, np.float32))
    head = _ellipse(x, y - 0.05, 0.27, 0.32)
    neck = np.minimum(0.12 - np.abs(x), -0.1 - y)
    shoulders = _ellipse(x, y + 0.75, 0.55, 0.47)
    person = np.maximum(np.maximum(head, neck), shoulders)
    E = cover(E, within(person, 2 * pixel), portrait)
    face = within(_ellipse(x, y - 0.02, 0.11, 0.15), pixel)
    return _picture(shape, E, face)


def snow(shape: tuple[int, int] = SHAPE) -> F32:
    """Return a snow field in the sun, with a hut far away: most of it reflects 86 % of the light."""
    x, y, pixel = _plane(shape)
    light = LIGHT["snow"]
    distance = 0.12 / np.maximum(0.32 - y, 0.02)
    ripple = _texels("gravel", 2.5 * x * distance, 2.5 * distance, 3 * pixel)[0] - 0.25
    drift = 0.05 * np.sin(9 * x + 14 * distance) + 0.04 * np.sin(23 * x - 9 * distance)
    E = light * np.clip(0.86 + drift + 0.25 * ripple, 0.4, 0.95) * rgb(0.98, 1.0, 1.04)
    above = y - 0.32 - 0.05 * np.sin(4 * x + 2) - 0.02 * np.sin(11 * x)
    E = cover(
        E, within(above, 2 * pixel), rgb(1500, 2600, 5200) * (1.3 - 0.8 * np.clip(above, 0, 1))
    )
    wall = np.minimum(0.06 - np.abs(x - 0.45), 0.04 - np.abs(y - 0.31))
    roof = np.minimum(0.035 - np.abs(y - 0.375), 0.1 - np.abs(x - 0.45) - 1.2 * (y - 0.36))
    E = cover(E, within(wall, pixel), light * 0.06 * rgb(1.4, 0.9, 0.6))
    E = cover(E, within(roof, pixel), light * 0.85 * rgb(1, 1, 1))
    return _picture(shape, E, within(0.2 - y, pixel))


def locomotive(shape: tuple[int, int] = SHAPE) -> F32:
    """Return a black locomotive, which fills the picture and reflects a twentieth of a dull day's light."""
    x, y, pixel = _plane(shape)
    light = LIGHT["locomotive"]
    E = rgb(2200, 2300, 2400) * (0.75 + 0.5 * _texels("grass", 0.4 * x, 0.8 * y, pixel)[:1])
    ballast = _texels("gravel", 2 * x, 4 * y, 4 * pixel)
    E = cover(E, within(-0.36 - y, 2 * pixel), light * 0.9 * ballast * rgb(1, 0.95, 0.9))
    boiler = np.minimum(0.21 - np.abs(y - 0.03), 0.44 - np.abs(x + 0.1))
    round_ = np.sqrt(np.clip(1 - ((y - 0.03) / 0.22) ** 2, 0, 1))
    sheen = 0.02 + 0.05 * np.exp(-(((y - 0.14) / 0.035) ** 2)) + 0.02 * round_
    cab = np.minimum(0.3 - np.abs(y - 0.04), 0.13 - np.abs(x - 0.45))
    chimney = np.minimum(0.06 - np.abs(x + 0.4), 0.12 - np.abs(y - 0.3))
    frame = np.minimum(0.03 - np.abs(y + 0.2), 0.62 - np.abs(x))
    black = np.maximum.reduce([boiler, cab, chimney, frame])
    E = cover(E, within(np.maximum(frame, cab), pixel), np.full((3, len(x)), 0.03 * light))
    E = cover(E, within(np.maximum(boiler, chimney), pixel), light * sheen * rgb(0.95, 1, 1.05))
    wheels = np.max(
        [_ellipse(x - at, y + 0.27, 0.115, 0.115) for at in (-0.42, -0.18, 0.06, 0.3)], axis=0
    )
    E = cover(E, within(wheels, pixel), np.full((3, len(x)), 0.025 * light))
    E = cover(E, within(0.012 - np.abs(wheels - 0.02), pixel), light * 0.09 * rgb(1, 1, 1))
    rod = np.minimum(0.012 - np.abs(y + 0.25), 0.4 - np.abs(x + 0.06))
    E = cover(E, within(rod, pixel), light * 0.12 * rgb(1, 1, 1))
    pane = np.minimum(0.07 - np.abs(x - 0.45), 0.06 - np.abs(y - 0.2))
    E = cover(E, within(pane, pixel), rgb(500, 520, 560))
    return _picture(shape, E, within(np.maximum(black, wheels), pixel))


SUBJECTS = {"backlight": backlight, "snow": snow, "locomotive": locomotive}
