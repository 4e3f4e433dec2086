"""Mosaics: a sensor has one color filter per pixel; neighbors fill in the other colors (Bayer, 1976).

E    light      (H, W, 3), what falls on the sensor
c    channel    (H, W) int, 0 to 2: the colour of each pixel's filter
X    mosaic     (H, W), X = E_c: what the sensor sees
E^   estimate of E (H, W, 3), each channel a weighted mean of the nearest pixels that measured it
"""

import math
from typing import Any

import numpy as np
from scipy.ndimage import correlate

from hdrlab.core.arrays import Array, ArrayLike, Indices, NDArray, describe
from hdrlab.errors import InputError

# channels, R G / G B
BAYER = np.array([[0, 1], [1, 2]])
# weights, which fall to 0 at a distance of two pixels
TENT = np.array([[1.0, 2, 1], [2, 4, 2], [1, 2, 1]]) / 4


def tile(pattern: ArrayLike, shape: tuple[int, ...]) -> Array:
    """Return a pattern (h, w) repeated over a sensor of shape (H, W).

    Examples
    --------
    >>> tile(BAYER, (2, 4)).tolist()
    [[0, 1, 0, 1], [1, 2, 1, 2]]
    """
    p = np.asarray(pattern)
    if p.ndim != 2 or 0 in p.shape or len(shape) != 2 or min(shape) < 1:
        raise InputError(f"expected a pattern (h, w) and a shape (H, W), got {p.shape} and {shape}")
    H, W = shape
    h, w = p.shape
    repeats = (math.ceil(H / h), math.ceil(W / w))
    return np.tile(p, repeats)[:H, :W]


def sample(E: ArrayLike, c: ArrayLike) -> Array:
    """Return X = E_c, the mosaic (H, W) of a picture (H, W, 3): each pixel's channel of its filter."""
    c = as_channels(c, np.shape(E)[:2])
    E = np.asarray(E)
    if E.ndim != 3 or E.shape[2] != 3:
        raise InputError(f"expected a picture (H, W, 3), got {describe(E)}")
    return np.take_along_axis(E, c[..., None], axis=-1)[..., 0]


def as_channels(c: ArrayLike, shape: tuple[int, ...]) -> Indices:
    """Return the channels (H, W) of a sensor's pixels, 0 to 2, or raise a ValueError."""
    channels = np.asarray(c)
    if channels.shape != tuple(shape) or not np.all(np.isin(channels, (0, 1, 2))):
        raise InputError(
            f"expected channels 0 to 2 of shape {tuple(shape)}, got {describe(channels)}"
        )
    return channels.astype(np.intp)


def demosaic(X: ArrayLike, c: ArrayLike) -> NDArray[np.floating[Any]]:
    """Return the picture E^ (H, W, 3) of a Bayer mosaic; missing channels are means of neighbors.

    Each channel is X where its filter is, and T (m X) / T m elsewhere, with m = 1 where its filter
    is and T the tent. Inside a Bayer picture this is bilinear interpolation; at the picture's edge
    it is the mean of the neighbors that exist. Edges get colored fringes, because the channels are
    sampled in different places.
    """
    c = as_channels(c, np.shape(X))
    X = np.asarray(X)
    X = X.astype(np.result_type(X, np.float32), copy=False)
    channels = []
    for k in range(3):
        is_channel = c == k
        mean = _neighbor_mean(X, is_channel.astype(X.dtype))
        channels.append(np.where(is_channel, X, mean))
    return np.stack(channels, axis=-1)


def _neighbor_mean(X: Array, m: Array) -> Array:
    """Return T (m X) / T m, the mean by the tent over the pixels where m is 1."""
    weight = correlate(m, TENT, mode="constant")
    return correlate(X * m, TENT, mode="constant") / np.maximum(weight, 1e-9)
