"""Skin detection by colour (Battiato et al. 2008, sec. 1.3.2).

Z      picture       (..., 3) levels 0 to 255, sRGB
x      chrominance   (..., 2) = (Cb, Cr), levels around 0
mu, S  mean (2,) and covariance (2, 2) of the chrominance of skin
d      Mahalanobis distance of a pixel from them
p      density p(x | skin)
r, g   R / (R + G + B), G / (R + G + B): colour without brightness

There are two methods. A Gaussian over the chrominance gives the probability density of a skin
colour. And the colours of skin under many light sources, from candle to sky, lie in a crescent of
the (r, g) plane between two parabolas, the skin locus. As it includes any light source, it finds
more skin, but also wood, hair and orange cloth.

The Gaussian comes from a training set. The default training set is computed: skin is a stack of
filters, melanin over blood, so its log reflectance moves along a line from light to dark. The line
goes through the two skins of the ColorChecker and a little beyond, with more or less blood, shade
and white balance. `fit` computes the Gaussian of another training set.
"""

from typing import NamedTuple

import numpy as np

from hdrlab.core.arrays import F64, ArrayLike, Mask
from hdrlab.errors import InputError

# Y of RGB [BT.601]
LUMA = np.array([0.299, 0.587, 0.114])
# Cb, Cr of RGB [BT.601]
CHROMA = np.array([[-0.168736, -0.331264, 0.5], [0.5, -0.418688, -0.081312]])
# sRGB of the ColorChecker's two skins
LIGHT = (194, 150, 130)
DARK = (115, 82, 68)
# parabolas in r [Soriano03]
UPPER = (-1.3767, 1.0743, 0.1452)
LOWER = (-0.776, 0.5601, 0.1766)
# squared distance from white in the (r, g) plane; nearer colours are left out of the locus
WHITE_RADIUS_SQUARED = 0.0004
# 96 % of a Gaussian lie within this Mahalanobis distance
MAX_DISTANCE = 2.5


class Skin(NamedTuple):
    """The colour of skin: mean (2,) and covariance (2, 2) of (Cb, Cr)."""

    mu: F64
    S: F64


# from the computed training set, at the brightness of a visibility image; a test computes it again
DEFAULT = Skin(
    np.array([-17.12975, 23.91754]), np.array([[20.25376, -25.10826], [-25.10826, 49.34927]])
)


def chrominance(Z: ArrayLike) -> F64:
    """Return x = 128 (Cb, Cr) / Y of levels (..., 3), the chrominance of the same colour at level 128.

    Without the division by Y, as in the paper, Cb and Cr would be smaller in the shade.
    """
    Z = np.asarray(Z, np.float64)
    return 128 * (Z @ CHROMA.T) / np.maximum(Z @ LUMA, 1)[..., None]


def fit(Z: ArrayLike) -> Skin:
    """Return the mean and covariance of the chrominance of training pixels (N, 3), levels 0 to 255.

    Raises
    ------
    ValueError
        For fewer than three pixels, or colours on one line, whose covariance is singular.
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


def distance(Z: ArrayLike, skin: Skin | None = None) -> F64:
    """Return d with d^2 = (x - mu)' S^-1 (x - mu), of each pixel (..., 3) [Battiato08 eq. 1.8].

    Without `skin`, the Gaussian is `DEFAULT`.
    """
    mu, S = DEFAULT if skin is None else skin
    difference = chrominance(Z) - mu
    inverse = np.linalg.inv(S)
    return np.sqrt(np.einsum("...i,ij,...j->...", difference, inverse, difference))


def likelihood(Z: ArrayLike, skin: Skin = DEFAULT) -> F64:
    """Return p(x | skin) = exp(-d^2 / 2) / (2 pi |S|^(1/2)) [Battiato08 eq. 1.7]."""
    S = skin.S
    return np.exp(-(distance(Z, skin) ** 2) / 2) / (2 * np.pi * np.sqrt(np.linalg.det(S)))


def find_by_chrominance(Z: ArrayLike, skin: Skin = DEFAULT, *, reach: float = MAX_DISTANCE) -> Mask:
    """Return the pixels (...) whose Mahalanobis distance from skin is below `reach`."""
    return distance(Z, skin) < reach


def find_by_locus(Z: ArrayLike) -> Mask:
    """Return the pixels (...) between the parabolas of the skin locus, except white [Soriano03].

    Examples
    --------
    >>> find_by_locus(np.array([[224, 172, 105], [60, 90, 200]])).tolist()  # skin, and a blue cloth
    [True, False]
    """
    Z = np.asarray(Z, np.float64)
    total = np.maximum(Z.sum(axis=-1), 1)
    r = Z[..., 0] / total
    g = Z[..., 1] / total
    is_white = (r - 1 / 3) ** 2 + (g - 1 / 3) ** 2 <= WHITE_RADIUS_SQUARED
    is_in_locus = (np.polyval(LOWER, r) < g) & (g < np.polyval(UPPER, r))
    return is_in_locus & ~is_white & (r > g)


FINDERS = {"chrominance": find_by_chrominance, "locus": find_by_locus}
