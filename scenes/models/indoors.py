"""What is seen through the windows of a street at night: lit rooms, and the shelves of a shop.

E  radiance (h, w, 3), cd/m^2
"""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

Float = NDArray[np.float64]


def interior(seed: int, colour: tuple[float, float, float], size: int = 96) -> Float:
    """Return the radiance of a lit room behind a window, cd/m^2: a lamp, curtains, a picture, furniture."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[:size, :size] / size
    lamp = rng.uniform(0.3, 0.7), rng.uniform(0.25, 0.6)
    light = (
        0.12
        + np.exp(-((y - lamp[0]) ** 2 + (x - lamp[1]) ** 2) / 0.12)
        + 5 * (np.hypot((y - lamp[0]) * 1.2, x - lamp[1]) < 0.055)
    )
    light[(y > 0.72) & (np.abs(x - 0.62) < 0.25)] *= 0.2
    frame = (np.abs(x - 0.7) < 0.1) & (np.abs(y - 0.3) < 0.1)
    light[frame] *= 0.45
    curtain = (x < 0.16 + 0.06 * y) | (x > 0.84 - 0.06 * y)
    fold = 0.42 + 0.2 * np.sin(x * 90)
    light = np.where(curtain, 0.5 * fold, light)
    tint = np.where(curtain[..., None], [1.0, 0.6, 0.4], [1.0, 1.0, 1.0])
    return gaussian_filter(light, 0.8)[..., None] * tint * np.array(colour)


def goods(size: int = 256) -> Float:
    """Return the radiance of the back of the shop, cd/m^2: shelves full of things, under lamps."""
    rng = np.random.default_rng(21)
    y, x = np.mgrid[:size, :size] / size
    back = 0.5 * np.exp(-1.5 * y)[..., None] * np.array([1.0, 0.82, 0.55])
    for row in range(4):
        edge = 0.05
        while edge < 0.93:
            wide = rng.uniform(0.02, 0.06)
            tall = rng.uniform(0.06, 0.18)
            top = 0.26 + 0.23 * row
            thing = (x > edge) & (x < edge + wide) & (y < top) & (y > top - tall)
            back[thing] = rng.uniform(0.08, 0.9, 3) * (1.1 - 0.15 * row)
            edge += wide + rng.uniform(0.003, 0.03)
        back[np.abs(y - 0.27 - 0.23 * row) < 0.008] = (0.1, 0.06, 0.03)
    for lamp in (0.2, 0.5, 0.8):
        back += (2.5 * np.exp(-((x - lamp) ** 2 + (y - 0.02) ** 2) / 0.004))[..., None] * np.array(
            [1.0, 0.85, 0.6]
        )
    return 170 * gaussian_filter(back, (0.8, 0.8, 0))
