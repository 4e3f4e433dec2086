"""Factors that a response does not determine: channel scales and unit (Mitsunaga and Nayar 1999, sec. 6.4).

M   measured brightness   (N, 3), 0 ... 1
I   radiance              (N, 3), each channel in a unit of its own
k   channel scales        (3,), k_green = 1

Each channel's response is known up to a factor, and so is its radiance. So a radiance map that is
recovered channel by channel may have a tint. If the camera preserves chromaticity, k I must have
the direction of M for all pixels.
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
    """Return the channel scales k for which k I is nearest to the direction of M [Mitsunaga99 sec. 6.4].

    Parameters
    ----------
    I : (..., 3) float
        Radiance as recovered, positive.
    M : (..., 3) float
        Brightness of the same pixels in a photograph, any unit, positive; leave out pixels that are
        black or clipped.

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

    def residuals(ln_k: F64) -> F64:
        return (chromaticity(I * np.exp([ln_k[0], 0, ln_k[1]])) - target).ravel()

    start = (first - first[1])[[0, 2]]
    ln_k = scipy.optimize.least_squares(residuals, start).x
    return np.exp([ln_k[0], 0.0, ln_k[1]])


def fit_unit(E: ArrayLike, x: int, y: int, reading: float) -> float:
    """Return k for which k E is in cd/m^2, from the reading of a light meter at one place.

    Parameters
    ----------
    E : (H, W) or (H, W, 3), radiance in any unit
    x, y : the place, in pixels from the left and from the top; the map is averaged over a square
        around it, a hundredth of the map's width wide
    reading : luminance of the place, cd/m^2

    Returns
    -------
    k : the reading over the mean luminance of that square

    Raises
    ------
    ValueError
        For a place outside the map or without light, for a reading that is not positive, and for a
        quotient beyond float32.

    Examples
    --------
    >>> fit_unit(np.full((20, 30), 0.5), 10, 5, 120.0)
    240.0
    """
    L = luminance(as_radiance(E))
    height, width = L.shape
    radius = max(1, width // 200)
    is_inside = 0 <= y < height and 0 <= x < width
    rows = slice(max(y - radius, 0), y + radius + 1)
    columns = slice(max(x - radius, 0), x + radius + 1)
    if not (is_inside and L[rows, columns].any() and 0 < reading < np.inf):
        raise InputError(
            f"expected a reading above 0 cd/m^2 at a pixel with light within {width} x {height}, "
            f"got {reading:g} at {x},{y}"
        )
    k = float(reading) / float(L[rows, columns].mean(dtype=np.float64))
    if k > float(np.finfo(np.float32).max):
        raise InputError(
            f"expected a pixel with more light, because {reading:g} cd/m^2 over the radiance at {x},{y} "
            "does not fit into float32"
        )
    return k
