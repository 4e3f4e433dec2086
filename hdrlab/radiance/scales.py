"""What a response leaves open: the unit of light, and of its colours (Mitsunaga and Nayar 1999, sec. 6.4).

M   measured brightness   (N, 3), 0 ... 1
I   radiance              (N, 3), each channel in a unit of its own
k   channel scales        (3,), k_green = 1

Each channel's response is known up to a factor, and so is the radiance: a picture recovered channel
by channel has a tint that no photograph had. If the camera, whatever its curve, kept the
chromaticity of what it saw, then k I must point along M, for all pixels together.
"""

import numpy as np
import scipy

from hdrlab.core.arrays import F64, ArrayLike, as_radiance, describe
from hdrlab.core.colour import luminance
from hdrlab.errors import InputError


def chromaticity(M: ArrayLike) -> F64:
    """Return M / |M|, (..., 3)."""
    M = np.asarray(M, np.float64)
    return M / np.linalg.norm(M, axis=-1, keepdims=True)


def fit_channel_scales(I: ArrayLike, M: ArrayLike) -> F64:  # noqa: E741
    """Return k that brings k I nearest to the direction of M, by least squares [Mitsunaga99 sec. 6.4].

    Parameters
    ----------
    I : (..., 3) float
        Radiance as recovered, positive.
    M : (..., 3) float
        What a photograph shows of it, any unit, positive; leave out pixels that are black or
        clipped.

    Returns
    -------
    (3,) float64
        k, which minimises sum |k I / |k I| - M / |M||^2; k[1] = 1, as only the ratios are fixed.

    Raises
    ------
    ValueError
        For arrays that do not fit together, or are not positive.

    Examples
    --------
    >>> M = np.random.default_rng(0).uniform(0.1, 1, (100, 3))
    >>> fit_channel_scales(M * [2, 5, 4], M).round(6)
    array([2.5 , 1.  , 1.25])
    """
    I = np.asarray(I, np.float64)  # noqa: E741
    M = np.asarray(M, np.float64)
    if I.shape != M.shape or I.shape[-1:] != (3,) or I.size == 0:
        raise InputError(
            f"expected radiance and brightness (..., 3), got {describe(I)} and {describe(M)}"
        )
    if not (np.all(np.isfinite(I) & (I > 0)) and np.all(np.isfinite(M) & (M > 0))):
        raise InputError(
            f"expected positive radiance and brightness, got {describe(I)} and {describe(M)}"
        )
    I = I.reshape(-1, 3)  # noqa: E741
    target = chromaticity(M.reshape(-1, 3))
    first = np.median(np.log(target / I), axis=0)

    def misses(ln_k: F64) -> F64:
        return (chromaticity(I * np.exp([ln_k[0], 0, ln_k[1]])) - target).ravel()

    ln_k = scipy.optimize.least_squares(misses, (first - first[1])[[0, 2]]).x
    return np.exp([ln_k[0], 0.0, ln_k[1]])


def fit_unit(E: ArrayLike, x: int, y: int, reading: float) -> float:
    """Return k that makes k E cd/m^2, from what a meter read at one place.

    Parameters
    ----------
    E : (H, W) or (H, W, 3), radiance in a unit of its own
    x, y : the place, in pixels from the left and from the top; a hundredth of the width around it
        counts
    reading : its luminance, cd/m^2

    Returns
    -------
    k : the reading over the mean luminance of that place

    Raises
    ------
    ValueError
        For a place outside the map or without light, and for a reading that is not positive.

    Examples
    --------
    >>> fit_unit(np.full((20, 30), 0.5), 10, 5, 120.0)
    240.0
    """
    L = luminance(as_radiance(E))
    reach = max(1, L.shape[1] // 200)
    inside = 0 <= y < L.shape[0] and 0 <= x < L.shape[1]
    seen = (
        L[max(y - reach, 0) : y + reach + 1, max(x - reach, 0) : x + reach + 1] if inside else L[:0]
    )
    if not (seen.any() and 0 < reading < np.inf):
        size = f"{L.shape[1]} x {L.shape[0]}"
        raise InputError(
            f"expected cd/m^2 of a lit place in {size} pixels, got {reading:g} at {x},{y}"
        )
    return float(reading / seen.mean())
