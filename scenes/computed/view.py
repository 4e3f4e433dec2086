"""Scenes whose radiance is known, to be photographed by `capture.camera`.

E  radiance (H, W, 3) float32, cd/m^2, primaries of sRGB
d  directions of sight (3, N), d_z = 1: x to the right, y up, z ahead
"""

import numpy as np

from hdrlab.core.arrays import F32, NDArray
from scenes.computed.interior import trace
from scenes.computed.textures import Points

# lines of sight traced at a time: their arrays stay near the processor
SIGHTS_PER_BAND = 2**16


def sight(shape: tuple[int, int], rows: NDArray[np.int_]) -> tuple[Points, float]:
    """Return d through the pixels of some rows of a frame, and the width of a pixel at z = 1."""
    height, width = shape
    pixel = 1 / (0.72 * np.sqrt(height * width))
    d = np.ones((3, len(rows), width), np.float32)
    d[0] = (np.arange(width) + 0.5 - width / 2) * pixel
    d[1] = (
        0.43 * height - 0.5 - rows[:, None]
    ) * pixel  # the horizon lies a little above the middle
    return d.reshape(3, -1), pixel


def room(
    shape: tuple[int, int] = (512, 768),
    *,
    sun: float = 10_000.0,
    lamp: float = 6_000.0,
    samples: int = 2,
) -> F32:
    """Return the radiance of a room with a bright window, five decades and a half from sun to dark corner.

    Late afternoon. Garden and sun stand in the window, whose bars cast shadows into the light on
    the tiles; a lamp burns by the pictures on the right. An exposure that holds the clouds leaves
    the room dim; one that shows the bricks on the left has lost the garden; and only the longest
    finds who lives in the unlit room.

    Parameters
    ----------
    shape : (H, W), pixels; the angle of view follows their number, so that a pixel is square
    sun : cd/m^2, radiance of the sun's disc; its beam and its glow grow with it. The true one,
        1.6e9, would
        take another seventeen stops, and a photographer a filter.
    lamp : cd/m^2, radiance of the lamp's globe; its light on the walls grows with it
    samples : lines of sight per pixel in each direction, which are averaged

    Returns
    -------
    E : (H, W, 3) float32, cd/m^2, positive everywhere

    Raises
    ------
    ValueError
        For a shape that is not two positive numbers, negative lights, or no samples.

    Examples
    --------
    >>> E = room((64, 96))
    >>> E.shape, E.dtype
    ((64, 96, 3), dtype('float32'))
    """
    if len(shape) != 2 or min(shape) < 1 or samples < 1:
        raise ValueError(f"expected a shape (H, W) and a sample or more, got {shape} and {samples}")
    if not (0 <= sun < np.inf and 0 <= lamp < np.inf):
        raise ValueError(
            f"expected finite lights of at least 0 cd/m^2, got sun {sun} and lamp {lamp}"
        )
    height, width = shape
    E = np.empty((height, width, 3), np.float32)
    step = max(SIGHTS_PER_BAND // (width * samples**2), 1)
    for top in range(0, height, step):
        rows = np.arange(samples * top, samples * min(top + step, height))
        d, pixel = sight((samples * height, samples * width), rows)
        band = trace(d, pixel, sun, lamp).reshape(3, -1, samples, width, samples)
        E[top : top + step] = np.moveaxis(band.mean(axis=(2, 4)), 0, -1)
    return E
