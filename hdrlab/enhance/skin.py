"""Skin in a photograph, by its colour (Battiato et al. 2008, sec. 1.3.2).

Z      picture       (..., 3) levels 0 to 255, sRGB
x      chrominance   (..., 2) = (Cb, Cr), levels around 0
mu, S  mean (2,) and covariance (2, 2) of the chrominance of skin
d      Mahalanobis distance of a pixel from them
p      density p(x | skin)
r, g   R / (R + G + B), G / (R + G + B): colour without brightness

Two ways. A Gaussian over the chrominance says how likely a colour is skin's. And the colours of
skin under many lamps, from candle to sky, lie in the (r, g) plane in a crescent between two
parabolas: the skin locus. It is wider, for it takes any lamp: it finds more skin, and wood, hair
and orange cloth too.

The Gaussian comes from a training set. The default one is computed: skin is a stack of filters,
melanin over blood, so its log reflectance moves along a line from light to dark. The line goes
through the two skins of the ColorChecker and a little beyond, with more or less blood, shade and
white balance. `fit` takes one of your own.
"""

from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, Mask
from hdrlab.errors import InputError

LUMA = np.array([0.299, 0.587, 0.114])  # Y of RGB [BT.601]
CHROMA = np.array(
    [[-0.168736, -0.331264, 0.5], [0.5, -0.418688, -0.081312]]
)  # Cb, Cr of RGB [BT.601]
# sRGB of the ColorChecker's two skins
LIGHT = (194, 150, 130)
DARK = (115, 82, 68)
# parabolas in r [Soriano03]
UPPER = (-1.3767, 1.0743, 0.1452)
LOWER = (-0.776, 0.5601, 0.1766)
# squared radius of the white that is left out of the locus
WHITE = 0.0004
# Mahalanobis distance: of a Gaussian, 96 % lie nearer
REACH = 2.5


class Skin(NamedTuple):
    """What skin looks like: mean (2,) and covariance (2, 2) of (Cb, Cr)."""

    mu: F64
    S: F64


# Of the computed training set, at the brightness of a visibility image; a test computes it again.
DEFAULT = Skin(
    np.array([-17.12975, 23.91754]), np.array([[20.25376, -25.10826], [-25.10826, 49.34927]])
)


def chrominance(Z: ArrayLike) -> F64:
    """Return x = 128 (Cb, Cr) / Y of levels (..., 3): the chrominance that a colour would have at level 128.

    Cb and Cr alone shrink in the shade, and so would the distance from gray; divided by Y they do
    not.
    """
    Z = np.asarray(Z, np.float64)
    return 128 * (Z @ CHROMA.T) / np.maximum(Z @ LUMA, 1)[..., None]


def fit(Z: ArrayLike) -> Skin:
    """Return the mean and covariance of the chrominance of training pixels (N, 3), levels 0 to 255.

    Raises
    ------
    ValueError
        For fewer than three pixels, or colours that lie on one line: they have no covariance.
    """
    Z = np.asarray(Z, np.float64)
    if Z.ndim != 2 or Z.shape[1] != 3 or len(Z) < 3:
        raise InputError(f"expected training pixels (N, 3), at least three, got shape {Z.shape}")
    x = chrominance(Z)
    S = np.cov(x.T)
    if not np.linalg.det(S) > 1e-9:
        raise InputError(
            f"expected training pixels of different colours, got a covariance of {S.tolist()}"
        )
    return Skin(x.mean(axis=0), S)


def distance(Z: ArrayLike, skin: Skin = DEFAULT) -> F64:
    """Return d with d^2 = (x - mu)' S^-1 (x - mu), of each pixel (..., 3) [Battiato08 eq. 1.8]."""
    away = chrominance(Z) - skin.mu
    return np.sqrt(np.einsum("...i,ij,...j->...", away, np.linalg.inv(skin.S), away))


def likelihood(Z: ArrayLike, skin: Skin = DEFAULT) -> F64:
    """Return p(x | skin) = exp(-d^2 / 2) / (2 pi |S|^(1/2)) [Battiato08 eq. 1.7]."""
    S = skin.S
    return np.exp(-(distance(Z, skin) ** 2) / 2) / (2 * np.pi * np.sqrt(np.linalg.det(S)))


def find_by_chrominance(Z: ArrayLike, skin: Skin = DEFAULT, *, reach: float = REACH) -> Mask:
    """Return the pixels (...) whose Mahalanobis distance from skin is below `reach`."""
    return distance(Z, skin) < reach


def find_by_locus(Z: ArrayLike) -> Mask:
    """Return the pixels (...) between the parabolas of the skin locus, white left out [Soriano03].

    Examples
    --------
    >>> find_by_locus(np.array([[224, 172, 105], [60, 90, 200]])).tolist()  # skin, and a blue cloth
    [True, False]
    """
    Z = np.asarray(Z, np.float64)
    total = np.maximum(Z.sum(axis=-1), 1)
    r = Z[..., 0] / total
    g = Z[..., 1] / total
    white = (r - 1 / 3) ** 2 + (g - 1 / 3) ** 2 <= WHITE
    return (np.polyval(LOWER, r) < g) & (g < np.polyval(UPPER, r)) & ~white & (r > g)


FINDERS = {"chrominance": find_by_chrominance, "locus": find_by_locus}
