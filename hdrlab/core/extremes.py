"""Robust extremes of an image, on which hot and black pixels have no influence.

L    luminance            (H, W) float32, >= 0
cut  fraction left out    of the positive pixels, and at least one pixel
"""

import math

import numpy as np

from hdrlab.core.arrays import F32, ArrayLike
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError

# A picture with more pixels is ranked by every second, third, ... of them.
_MAX_RANKED_PIXELS = 1 << 18


def positive(L: F32) -> F32:
    """Return the luminances above 0, as a list: log L exists there."""
    if L.min() > 0:
        return L.ravel()
    return L[L > 0]


def robust_minimum(L: F32, *, cut: float = 1e-4) -> float:
    """Return the luminance that a fraction `cut` of the positive pixels lies below; 0 without light."""
    return _ranked(positive(L), cut, from_top=False)


def robust_maximum(L: F32, *, cut: float = 1e-4) -> float:
    """Return the luminance that a fraction `cut` of the positive pixels lies above; 0 without light.

    Examples
    --------
    >>> L = np.append(np.linspace(1, 2, 999), 1e6).astype(np.float32)  # one hot pixel
    >>> round(robust_maximum(L), 2)
    2.0
    """
    return _ranked(positive(L), cut, from_top=True)


def positive_median(L: F32) -> float:
    """Return the median of the positive luminances; 0 without light."""
    return robust_maximum(L, cut=0.5)


def _ranked(values: F32, cut: float, *, from_top: bool) -> float:
    if not values.size:
        return 0.0
    values = values[:: math.ceil(values.size / _MAX_RANKED_PIXELS)]
    most = (values.size - 1) // 2  # even of a tiny picture, a pixel must be left
    left_out = min(max(1, int(cut * values.size)), most)
    rank = values.size - 1 - left_out if from_top else left_out
    return float(np.partition(values, rank)[rank])


def decades(E: ArrayLike, *, tail: float = 0.001) -> float:
    """Return log10(L_high / L_low), the range of a scene or of a radiance map.

    Parameters
    ----------
    E : (H, W) or (H, W, 3), radiance
    tail : share of the positive pixels left out at each end, so that one odd pixel decides nothing;
        with 0,
        L_high and L_low are the maximum and the minimum

    Returns
    -------
    decades : powers of ten; times 3.32 it is stops, times 20 decibels

    Raises
    ------
    ValueError
        For radiance that is not finite or negative, without a positive pixel, or a tail outside [0,
        0.5).

    Examples
    --------
    >>> round(decades([[0.01, 1000.0]], tail=0), 3)
    5.0
    """
    if not 0 <= tail < 0.5:
        raise InputError(f"expected a tail in [0, 0.5), got {tail}")
    L = luminance(E)
    if not L.any():
        raise InputError("expected radiance with positive pixels, got only zeros")
    low, high = np.quantile(L[L > 0].astype(np.float64), [tail, 1 - tail])
    return float(np.log10(high / low))
