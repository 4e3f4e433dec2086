"""Khronos PBR Neutral, a view transform (The Khronos Group, PBR Neutral Tone Mapper, specification of 2024).

C        color                     (..., 3) >= 0, linear, primaries of sRGB, 1 = white paper
x        its smallest channel
f        offset                    what a glossy surface reflects of a white surrounding, at most 0.04
p        its largest channel, after the offset
p'       compressed peak           below 1
display  linear display RGB        (..., 3), 0 to 1

A tone-mapping operator maps luminance, and colors follow. A view transform maps the three channels
of a color, and so it also decides how a bright color becomes white. It expects a fixed unit of
light: 1 is white paper. This one is for products in a shop: up to p = 0.76, a color is shown as it
is, less the gloss of its surface. Above, its peak is compressed, and the color moves straight toward
white, which keeps its hue: the angle around the gray axis.
"""

import numpy as np

from hdrlab.core.arrays import F32, F64, ArrayLike, as_luminance
from hdrlab.tonemap.view_unit import scale_colors

LAWS = ("monotone", "exposure")
# F90 of the specification, the reflectance of glass and plastic seen from the front
REFLECTANCE = 0.04
# Ks: up to this peak, colors are not compressed
COMPRESSION_START = 0.8 - REFLECTANCE
# Kd: how fast colors become white above it
DESATURATION = 0.15


def offset(x: ArrayLike) -> F64:
    """Return f = x - x^2 / (4 F90) up to x = 2 F90 = 0.08, and F90 = 0.04 above it."""
    x = np.asarray(x, np.float64)
    return np.where(x < 2 * REFLECTANCE, x - x**2 / (4 * REFLECTANCE), REFLECTANCE)


def compress(p: ArrayLike) -> F64:
    """Return p' = p up to Ks = 0.76, and 1 - (1 - Ks)^2 / (p + 1 - 2 Ks) above it, where the slope is 1."""
    p = np.asarray(p, np.float64)
    room = 1 - COMPRESSION_START
    above = np.maximum(p - COMPRESSION_START, 0)
    return np.where(above > 0, 1 - room**2 / (above + room), p)


def view(C: ArrayLike) -> F64:
    """Return the display colors C' = (C - f) p' / p, mixed with the gray p' by g = 1 - 1 / (Kd (p - p') + 1).

    Parameters
    ----------
    C : (..., 3) linear RGB, not negative, 1 = white paper

    Returns
    -------
    (..., 3) float64 linear display RGB, from 0 to below 1

    Examples
    --------
    >>> view([[0.18, 0.18, 0.18], [0.1, 0.3, 0.7], [0.1, 0.3, 70.0]]).round(2)
    array([[0.14, 0.14, 0.14],
           [0.06, 0.26, 0.66],
           [0.91, 0.91, 1.  ]])
    """
    C = np.asarray(C, np.float64)
    C = C - offset(C.min(axis=-1, keepdims=True))
    p = C.max(axis=-1, keepdims=True)
    compressed = compress(p)
    C = C * (compressed / np.where(p > 0, p, 1))
    g = 1 - 1 / (DESATURATION * (p - compressed) + 1)
    return (1 - g) * C + g * compressed


def tonemap(L: ArrayLike, *, key: float = 0.18) -> F32:
    """Return display luminance of gray light through Khronos PBR Neutral.

    This is the transform's curve, for images without color. `tonemap_rgb` maps colors.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    key : what the log average of L becomes before the transform: 0.18 is middle gray, 1 is paper

    Returns
    -------
    (H, W) float32 in [0, 1], 1 = white

    Raises
    ------
    InputError
        For luminance that is not (H, W), finite and at least 0, and a key that is not positive.

    Examples
    --------
    >>> tonemap(np.full((1, 2), 300.0)).round(2)
    array([[0.14, 0.14]], dtype=float32)
    """
    L = as_luminance(L)
    C = np.stack([L, L, L], axis=-1)
    return tonemap_rgb(C, key=key)[..., 0]


def tonemap_rgb(E: ArrayLike, *, key: float = 0.18) -> F32:
    """Return display colors by Khronos PBR Neutral, after scaling the scene to the transform's unit.

    A scene that was rendered or measured in the transform's unit needs no scaling: use `view`.

    Parameters
    ----------
    E : (H, W, 3) radiance, finite and not negative, primaries of sRGB, any linear unit
    key : what the log average of luminance becomes before the transform

    Returns
    -------
    (H, W, 3) float32 linear display RGB in [0, 1]

    Raises
    ------
    InputError
        For radiance that is not (H, W, 3), finite and at least 0, and a key that is not positive.

    References
    ----------
    The Khronos Group, Khronos PBR Neutral Tone Mapper, specification, 2024.
    """
    return np.clip(view(scale_colors(E, key=key)), 0, 1).astype(np.float32)
