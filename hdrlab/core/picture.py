"""Statistics of a finished image: clipped pixels, brightness, contrast and entropy.

picture  (H, W) gray or (H, W, 3) RGB, uint8, as it is sent to the display
y        gray level, 0 to 255     (H, W) float64
p        fraction of the pixels at each level
"""

from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, as_picture
from hdrlab.core.colour import LUMINANCE


class Statistics(NamedTuple):
    """Statistics of an image (H, W[, 3]) uint8.

    Attributes
    ----------
    black : fraction of pixels that are 0 in every channel
    white : fraction of pixels that are 255 in at least one channel
    mean : gray level, 0 to 255
    contrast : standard deviation of the gray level
    entropy : of the 256 gray levels, 0 to 8 bits per pixel
    """

    black: float
    white: float
    mean: float
    contrast: float
    entropy: float


def gray(picture: ArrayLike) -> F64:
    """Return y = 0.2126 R + 0.7152 G + 0.0722 B of the encoded levels; a gray image is unchanged."""
    levels: F64 = as_picture(picture).astype(np.float64)
    return levels @ LUMINANCE if levels.ndim == 3 else levels


def statistics(picture: ArrayLike) -> Statistics:
    """Return plain figures of a picture (H, W) or (H, W, 3) uint8; a ValueError for anything else.

    Examples
    --------
    >>> statistics(np.array([[0, 0, 128, 255]], np.uint8)).black
    0.5
    """
    picture = as_picture(picture)
    y = gray(picture)
    channels = picture.reshape(*picture.shape[:2], -1)
    p = np.bincount(np.rint(y).astype(np.intp).ravel(), minlength=256) / y.size
    bits = -np.sum(p[p > 0] * np.log2(p[p > 0])) + 0.0  # of a constant 0, and not -0
    black = np.all(channels == 0, axis=-1)
    white = np.any(channels == 255, axis=-1)
    return Statistics(
        black=float(black.mean()),
        white=float(white.mean()),
        mean=float(y.mean()),
        contrast=float(y.std()),
        entropy=float(bits),
    )
