"""Metrics: the error of a result, compared with the truth of a simulated camera.

g        response    (n,) or (n, 3), ln f^-1, ln exposure of each level
E        radiance    (H, W[, 3]), any linear unit
offsets  (P, 2) int, (dy, dx) pixels
well     (H, W) bool, pixels that at least one frame exposed well

Photographs determine neither the unit of exposure nor the initial position of the camera. So one
factor, or one common shift, is removed before the comparison; each function documents which.
"""

from typing import NamedTuple

import numpy as np

from hdrlab.core import arrays
from hdrlab.core.arrays import F64, Array, ArrayLike, NDArray
from hdrlab.errors import InputError

# Of 256 levels: noise dominates below, the cut of the weights above.
LOW_LEVEL = 10
HIGH_LEVEL = 250
RELIABLE_LEVELS = slice(LOW_LEVEL, HIGH_LEVEL + 1)


class Truth(NamedTuple):
    """The truth of a simulated camera, which a calibration should find.

    Attributes
    ----------
    E : (h, w) or (h, w, 3), radiance of the scene where the map shows it, in any linear unit
    g : (n,) or (n, 3), the camera's response, ln exposure of each level
    offsets : (P, 2) int, (dy, dx) pixels, where each photograph must move
    """

    E: Array
    g: F64
    offsets: NDArray[np.int64]


def response_rmse(g: ArrayLike, truth: ArrayLike) -> F64:
    """Return the RMSE of f^-1 over the levels 10 to 250, in percent of the true f^-1(250), per channel.

    Each channel is first multiplied by the factor that fits it best (least squares), for a response
    is known only up to one.

    Parameters
    ----------
    g : (n,) or (n, C)
        The response that was found, ln exposure of each level.
    truth : (n,) or (n, C)
        The camera's own; one curve serves all channels.

    Returns
    -------
    (C,) float64
        Percent of the exposure at level 250.

    Raises
    ------
    ValueError
        For tables that are not responses, or numbers of channels that do not fit together.

    Examples
    --------
    >>> g = np.log(np.arange(1, 257))
    >>> response_rmse(g + 3, g).round(6) + 0.0  # another unit of exposure is no error
    array([0.])
    """
    g = arrays.as_table(g, 256).reshape(256, -1)
    g_true = arrays.as_response(truth, 256, g.shape[1])
    X = np.exp(g - g[HIGH_LEVEL])[RELIABLE_LEVELS]
    X_true = np.exp(g_true - g_true[HIGH_LEVEL])[RELIABLE_LEVELS]
    s = (X * X_true).sum(axis=0) / (X * X).sum(axis=0)
    return 100 * np.sqrt(((s * X - X_true) ** 2).mean(axis=0))


def well_exposed(images: ArrayLike, valid: NDArray[np.bool_] | None = None) -> NDArray[np.bool_]:
    """Return where some frame (P, H, W[, 3]) has a pixel's levels, in all channels, within 10 to 250."""
    stack = arrays.as_stack(images)
    Z = arrays.to_256(stack).reshape(*stack.shape[:3], -1)
    inside = ((Z >= LOW_LEVEL) & (Z <= HIGH_LEVEL)).all(axis=-1)
    return np.any(inside if valid is None else inside & valid, axis=0)


def radiance_errors(E: ArrayLike, truth: ArrayLike, well: ArrayLike) -> F64:
    """Return s E / E_true - 1 in every pixel and channel, (H, W[, 3]); NaN where the truth is without light.

    The factor s is one for all, and makes the median of s E / E_true over the pixels of `well` 1.

    Raises
    ------
    ValueError
        For shapes that do not fit together, or where no pixel of `well` can be compared.

    Examples
    --------
    >>> truth = np.array([[1.0, 2.0, 4.0]])
    >>> radiance_errors([[10.0, 20.0, 44.0]], truth, truth > 0).round(3)
    array([[0. , 0. , 0.1]])
    """
    E = arrays.as_radiance(E).astype(np.float64)
    truth = arrays.as_radiance(truth)
    well = np.asarray(well)
    if not (E.shape == truth.shape and E.shape[:2] == well.shape and well.dtype == bool):
        raise InputError(
            f"expected maps of one shape, got {E.shape}, {truth.shape}, {arrays.describe(well)}"
        )
    ratio = E / np.where(truth > 0, truth, np.nan)
    compared = ratio[well]
    compared = compared[np.isfinite(compared)]
    median = np.median(compared) if compared.size else 0.0
    if not median > 0:
        raise InputError("expected a well-exposed pixel with light, got none")
    return ratio / median - 1


def offset_errors(found: ArrayLike, truth: ArrayLike) -> NDArray[np.int64]:
    """Return found - truth (P, 2) in pixels, less the shift that most frames share: the whole map's."""
    found = np.asarray(found, np.int64)
    truth = np.asarray(truth, np.int64)
    if found.shape != truth.shape or found.ndim != 2 or found.shape[1] != 2:
        raise InputError(
            f"expected offsets (P, 2) twice, got {arrays.describe(found)} and {arrays.describe(truth)}"
        )
    apart = found - truth
    common = []
    for axis in apart.T:
        steps = (axis - axis.min()).astype(np.intp)
        common.append(np.bincount(steps).argmax() + axis.min())
    return apart - np.array(common)
