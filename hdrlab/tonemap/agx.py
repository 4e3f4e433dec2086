"""AgX, a view transform (Sobotka, AgX, 2022): the first version, with the outset of Wrensch, 2023.

C        color                     (..., 3) >= 0, linear, primaries of sRGB, 0.18 = middle gray
C'       color after the inset     (..., 3), each channel mixed with the two others
v        code of the logarithm     0 = 10 stops below middle gray, 1 = 6.5 stops above
S(v)     sigmoid                   display code, 0 to 1
display  linear display RGB        (..., 3), 0 to 1

A curve for each channel alone stops a bright pure blue at the display's pure blue: red and green
are 0, and stay 0. So the inset first moves all colors a fifth of the way to gray. As a color gets
brighter, its channels now reach the flat top of the sigmoid one after the other, and it becomes
white, as on film. The outset then gives the colors of middle brightness back what the inset took.

Blender's AgX (since 4.0) has this range and sigmoid, but other matrices, in the primaries of
BT.2020.
"""

import numpy as np

from hdrlab.core.arrays import F32, F64, ArrayLike, as_luminance
from hdrlab.tonemap.view_unit import scale_colors

LAWS = ("monotone", "exposure")
MIDDLE_GRAY = 0.18
# stops, from middle gray to the codes 0 and 1
LOWEST_STOP = -10.0
HIGHEST_STOP = 6.5
# Each channel keeps this part of itself ...
OWN_FRACTION = 0.8
# ... and gets these parts of R, G and B. They follow from the primaries of sRGB, moved away from
# white to 1.25 times their distance in the diagram of CIE x and y. Their sum with OWN_FRACTION is 1.
MIXED_FRACTIONS = np.array([0.0424010709504686, 0.0784365015618028, 0.0791624274877286])
# of the sigmoid, at middle gray
PIVOT = -LOWEST_STOP / (HIGHEST_STOP - LOWEST_STOP)
SLOPE = 2.0
# how sharply the sigmoid bends below and above middle gray
TOE_POWER = 3.0
SHOULDER_POWER = 3.25
# the exponent that the codes are made for
DISPLAY_GAMMA = 2.2


def inset(C: ArrayLike) -> F64:
    """Return C' = 0.8 C + 0.042 R + 0.078 G + 0.079 B for each channel C; a gray stays as it is."""
    C = np.asarray(C, np.float64)
    return OWN_FRACTION * C + np.sum(MIXED_FRACTIONS * C, axis=-1, keepdims=True)


def outset(C: ArrayLike) -> F64:
    """Return (C - 0.042 R - 0.078 G - 0.079 B) / 0.8 for each channel C, the inverse of the inset."""
    C = np.asarray(C, np.float64)
    return (C - np.sum(MIXED_FRACTIONS * C, axis=-1, keepdims=True)) / OWN_FRACTION


def encode_log(C: ArrayLike) -> F64:
    """Return v = (log2(C / 0.18) + 10) / 16.5, cut to 0 to 1."""
    darkest = MIDDLE_GRAY * 2.0**LOWEST_STOP
    stops = np.log2(np.maximum(C, darkest) / MIDDLE_GRAY)
    v = (stops - LOWEST_STOP) / (HIGHEST_STOP - LOWEST_STOP)
    return np.minimum(v, 1)


def sigmoid(v: ArrayLike) -> F64:
    """Return S = 1/2 + 2 (v - p) / (1 + a |v - p|^n)^(1/n), with the slope 2 at the pivot p = 10 / 16.5.

    n is 3 below the pivot and 3.25 above. a makes the curve go through 0 at v = 0 and 1 at v = 1: with
    q the distance from the pivot to that end, a = 4^n - q^-n.

    Examples
    --------
    >>> sigmoid([0, 0.3, 10 / 16.5, 0.8, 1]).round(3)
    array([0.   , 0.061, 0.5  , 0.855, 1.   ])
    """
    v = np.asarray(v, np.float64)
    n = np.where(v < PIVOT, TOE_POWER, SHOULDER_POWER)
    q = np.where(v < PIVOT, PIVOT, 1 - PIVOT)
    a = (2 * SLOPE) ** n - q**-n
    return 0.5 + SLOPE * (v - PIVOT) / (1 + a * np.abs(v - PIVOT) ** n) ** (1 / n)


def view(C: ArrayLike) -> F64:
    """Return the display colors outset(S(v))^2.2, where v is the logarithm of the inset.

    Parameters
    ----------
    C : (..., 3) linear RGB, not negative, 0.18 = middle gray

    Returns
    -------
    (..., 3) float64 linear display RGB, 0 to 1

    Examples
    --------
    >>> view([[0.18, 0.18, 0.18], [0.0, 0.0, 1.0], [0.0, 0.0, 70.0]]).round(2)
    array([[0.22, 0.22, 0.22],
           [0.08, 0.08, 0.66],
           [0.9 , 0.9 , 1.  ]])
    """
    code = outset(sigmoid(encode_log(inset(C))))
    return np.clip(code, 0, 1) ** DISPLAY_GAMMA


def tonemap(L: ArrayLike, *, key: float = 0.18) -> F32:
    """Return display luminance of gray light through AgX.

    This is the transform's curve, for images without color. `tonemap_rgb` maps colors.

    Parameters
    ----------
    L : (H, W) luminance, finite and not negative, any linear unit
    key : what the log average of L becomes before the transform: 0.18 is its middle gray

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
    array([[0.22, 0.22]], dtype=float32)
    """
    L = as_luminance(L)
    C = np.stack([L, L, L], axis=-1)
    return tonemap_rgb(C, key=key)[..., 0]


def tonemap_rgb(E: ArrayLike, *, key: float = 0.18) -> F32:
    """Return display colors by AgX, after scaling the scene to the transform's unit.

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
    Sobotka, AgX, an OpenColorIO configuration, 2022: the range, the sigmoid, the inset. Wrensch,
    Minimal AgX implementation, 2023: the outset, and the exponent 2.2.
    """
    return view(scale_colors(E, key=key)).astype(np.float32)
