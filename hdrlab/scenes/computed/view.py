"""Scenes whose radiance is known, to be photographed by `capture.camera`.

E  radiance (H, W, 3) float32, cd/m^2, primaries of sRGB
d  directions of sight (3, N), d_z = 1: x to the right, y up, z ahead
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hdrlab.core.colour import luminance
from hdrlab.core.types import F32
from hdrlab.scenes.computed.interior import trace
from hdrlab.scenes.computed.textures import Points

# lines of sight traced at a time: their arrays stay near the processor
SIGHTS_PER_BAND = 2**16


def sight(shape: tuple[int, int], rows: NDArray[np.int_]) -> tuple[Points, float]:
    """Return d through the pixels of some rows of a frame, and the width of a pixel at z = 1."""
    height, width = shape
    pixel = 1 / (0.72 * np.sqrt(height * width))
    d = np.ones((3, len(rows), width), np.float32)
    d[0] = (np.arange(width) + 0.5 - width / 2) * pixel
    d[1] = (0.43 * height - 0.5 - rows[:, None]) * pixel  # the horizon lies a little above the middle
    return d.reshape(3, -1), pixel


def room(
    shape: tuple[int, int] = (512, 768), *, sun: float = 10_000.0, lamp: float = 6_000.0, samples: int = 2
) -> F32:
    """Return the radiance of a room with a bright window, five decades and a half from sun to dark corner.

    Late afternoon. Garden and sun stand in the window, whose bars cast shadows into the light on the tiles; a
    lamp burns by the pictures on the right. An exposure that holds the clouds leaves the room dim; one that
    shows the bricks on the left has lost the garden; and only the longest finds who lives in the unlit room.

    Parameters
    ----------
    shape : (H, W), pixels; the angle of view follows their number, so that a pixel is square
    sun : cd/m^2, radiance of the sun's disc; its beam and its glow grow with it. The true one, 1.6e9, would
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
    >>> bool(decades(E, tail=0) > 5)
    True
    """
    if len(shape) != 2 or min(shape) < 1 or samples < 1:
        raise ValueError(f"expected a shape (H, W) and a sample or more, got {shape} and {samples}")
    if not (0 <= sun < np.inf and 0 <= lamp < np.inf):
        raise ValueError(f"expected finite lights of at least 0 cd/m^2, got sun {sun} and lamp {lamp}")
    height, width = shape
    E = np.empty((height, width, 3), np.float32)
    step = max(SIGHTS_PER_BAND // (width * samples**2), 1)
    for top in range(0, height, step):
        rows = np.arange(samples * top, samples * min(top + step, height))
        d, pixel = sight((samples * height, samples * width), rows)
        band = trace(d, pixel, sun, lamp).reshape(3, -1, samples, width, samples)
        E[top : top + step] = np.moveaxis(band.mean(axis=(2, 4)), 0, -1)
    return E


def decades(E: ArrayLike, *, tail: float = 0.001) -> float:
    """Return log10(L_high / L_low), the range of a scene or of a radiance map.

    Parameters
    ----------
    E : (H, W) or (H, W, 3), radiance
    tail : share of the positive pixels left out at each end, so that one odd pixel decides nothing; with 0,
        L_high and L_low are the maximum and the minimum

    Returns
    -------
    decades : powers of ten; times 3.32 it is stops, times 20 decibels

    Raises
    ------
    ValueError
        For radiance that is not finite or negative, without a positive pixel, or a tail outside [0, 0.5).

    Examples
    --------
    >>> round(decades([[0.01, 1000.0]], tail=0), 3)
    5.0
    """
    if not 0 <= tail < 0.5:
        raise ValueError(f"expected a tail in [0, 0.5), got {tail}")
    L = luminance(E)
    if not L.any():
        raise ValueError("expected radiance with a positive pixel, got zeros")
    low, high = np.quantile(L[L > 0].astype(np.float64), [tail, 1 - tail])
    return float(np.log10(high / low))
