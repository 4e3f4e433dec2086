"""What a window shows: a lawn with a path, a hedge, a hill, clouds, and the sun.

d      directions of sight (3, N), d_z = 1: x to the right, y up
pixel  width of a pixel in the plane z = 1
sun    radiance of the sun's disc, cd/m^2
E      radiance (3, N), cd/m^2
"""

import numpy as np

from scenes.computed.textures import Points, cover, look_up, rgb, within

SUN = rgb(0.2165, 0.175, 1.0)  # the direction of its centre
SUN_RADIUS = 0.028  # six times the true one, so that it has pixels in a small frame too
EYE_HEIGHT = 1.35


def sky(d: Points, pixel: float, sun: float) -> Points:
    """Return the light of the sky: blue above, pale at the horizon, clouds, and the sun in its glow."""
    x, y, _ = d
    E = cover(rgb(500, 1100, 2600), np.exp(np.maximum(y, 0) / -0.07), rgb(2500, 2200, 1800))
    blurred = look_up("grass", 0.3 + x / 2, 0.2 + y * 1.5, np.full(len(x), 0.012, np.float32))
    E = cover(E, 0.9 * within(blurred[0] - 0.247, 0.1), rgb(3000, 2850, 2700))
    away = np.hypot(x - SUN[0], y - SUN[1])
    glow = 0.35 * np.exp(away / -0.04) + 0.07 * np.exp(away / -0.2)
    return E + sun * (
        glow * rgb(1, 0.85, 0.6) + within(SUN_RADIUS - away, 2 * pixel) * rgb(1, 0.9, 0.7)
    )


def lawn(d: Points, pixel: float) -> Points:
    """Return the light of the ground that the sight meets below the horizon, with its winding path."""
    x, y, _ = d
    z = EYE_HEIGHT / np.maximum(-y, 1e-3)
    # seen at a slant, a pixel is longer than wide: a width between the two
    x = x * z
    w = pixel * z**1.5
    grass = look_up("grass", x / 2.5, z / 2.5, w / 2.5) * rgb(900, 1300, 260)
    gravel = look_up("gravel", x / 2, z / 2, w / 2) * rgb(2300, 2000, 1600)
    winding = 0.1 + 0.25 * np.sin(0.6 * z)
    return cover(grass, within(0.5 - np.abs(x - winding), 0.1 + 2 * pixel * z), gravel)


def outside(d: Points, pixel: float, sun: float) -> Points:
    """Return E: the sky behind the hill behind the hedge behind the lawn."""
    x, y, _ = d
    hill = 0.055 + 0.012 * np.sin(7 * x + 1) + 0.006 * np.sin(19 * x)
    hedge = 0.022 + 0.006 * np.sin(31 * x + 2) + 0.004 * np.sin(67 * x) + 0.003 * np.sin(131 * x)
    leaves = look_up("grass", 1.6 * x, 1.6 * y, np.full(len(x), 1.6 * pixel, np.float32)) * rgb(
        240, 390, 100
    )
    E = cover(sky(d, pixel, sun), within(hill - y, 2 * pixel), rgb(330, 420, 430))
    E = cover(E, within(hedge - y, 2 * pixel), leaves)
    return cover(E, within(-0.03 - y, 0.004 + pixel), lawn(d, pixel))
