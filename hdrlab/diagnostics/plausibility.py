"""Is a response consistent with its photographs? If not, times or frames are grossly wrong.

images  photographs   (P, H, W[, 3])
t       times         (P,) seconds, as stated
Z       ranks         (N, P, C), levels of equal rank in every frame: see `core.sampling`
g       response      (256,) or (256, 3), ln exposure of each level
error   stops         (P - 1,), by how much g(Z_j+1) - g(Z_j) departs from ln t_j+1 / t_j; median of size

Whatever it is given, least squares gives a curve. Three things show that it is none of a camera:
light that grows fainter as the exposure grows longer; neighbours that the curve itself leaves stops
apart; and a curve that spans more stops than any camera's, which is how two frames with a wrong
ratio explain each other. The limits are wide: times that are off by a stop or two give a curve, and
the map a doubt, see `contradictions`. Times that are off by a factor of 100 give an error, with one
exception. A linear camera, under ratios of 400 for 4, looks like one with a gamma of 4.3, and
nothing in its photographs says that there is no such thing.
"""

import numpy as np

from hdrlab.core import bracket, metrics, sampling
from hdrlab.core.arrays import (
    F64,
    Array,
    ArrayLike,
    Indices,
    Mask,
    as_mask,
    as_response,
    as_stack,
    as_times,
)
from hdrlab.diagnostics.doubts import warning_text
from hdrlab.errors import CalibrationError

# stops between neighbours; a bracket with wrong times that is still worth a map comes to 1.8
NEIGHBOUR_ERROR_LIMIT = 4.0
# stops, where half of three pairs or more are off by so much
MEDIAN_ERROR_LIMIT = 3.0
# levels by which equal ranks may differ, even where two histograms are one
RANK_NOISE = 2
# levels away from shoulder and toe, where scanned film has a floor, and the curve a cliff
INNER_LEVELS = 30, 225
# stops between the inner levels, of 201 measured curves and of our formulas
WIDEST_CAMERA = 10.2
# stops there; stated times that were off by a stop or two made a bracket's curve span 12.3
SPAN_LIMIT = 13.0
# ranks, and how many of them two frames must both hold, to be compared
RANKS, FEWEST_RANKS = 1000, 30
# pixels of a frame, on an even grid
PIXELS = 2**16


def ranks(stack: Array, valid: Mask | None) -> Indices:
    """Return Z (N, P, C) of an even choice of the pixels."""
    every = max(1, int(np.sqrt(stack.shape[1] * stack.shape[2] / PIXELS)))
    few = slice(None), slice(None, None, every), slice(None, None, every)
    shown = None if valid is None or not valid[few].all(axis=0).any() else valid[few]
    Z = sampling.by_rank(stack[few], RANKS, valid=shown)
    return Z.reshape(*Z.shape[:2], -1)


def neighbour_errors(Z: Indices, t: F64, g: F64) -> tuple[F64, F64]:
    """Return error and how often the longer of two frames is the darker one, (P - 1,) each, t rising.

    NaN where two frames hold too few ranks between the levels 10 and 250, or have the same time.
    """
    channel, inside = np.arange(Z.shape[-1]), (Z >= metrics.LOW_LEVEL) & (Z <= metrics.HIGH_LEVEL)
    both = inside[:, 1:] & inside[:, :-1] & (np.diff(t) > 0)[:, None]
    apart = np.abs(np.diff(g[Z, channel], axis=1) - np.diff(np.log(t))[:, None]) / np.log(2)
    darker, measured = np.diff(Z, axis=1) < -RANK_NOISE, both.sum(axis=(0, 2)) >= FEWEST_RANKS
    error, darker_share = np.full(len(measured), np.nan), np.full(len(measured), np.nan)
    for j in np.flatnonzero(measured):
        error[j], darker_share[j] = (
            np.median(apart[:, j][both[:, j]]),
            np.mean(darker[:, j][both[:, j]]),
        )
    return error, darker_share


def validate_response(
    g: F64, images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None
) -> F64:
    """Return g as it is, or raise a ValueError that says where the photographs contradict it.

    Parameters
    ----------
    g : (256,) or (256, 3) float
        A response, ln exposure of each level.
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        The photographs it was recovered from.
    times : (P,) float
        Their exposure times in seconds, as stated.
    valid : (P, H, W) bool, optional
        False where a photograph holds no picture.

    Raises
    ------
    ValueError
        Where a longer exposure is the darker one, where two neighbours are left more than 4 stops
        apart, or half of them more than 3, and where the curve spans more than 13 stops.

    Examples
    --------
    >>> g = np.log(np.maximum(np.arange(256), 0.25) / 128)  # a linear camera
    >>> images = np.stack([np.arange(20, 84), np.arange(40, 168, 2)]).astype(np.uint8).reshape(2, 8, 8)
    >>> validate_response(g, images, [1, 2]) is g
    True
    >>> validate_response(g, images, [1, 200])  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    hdrlab.errors.CalibrationError: the exposure times contradict the images: between 1 s and 200 s ...
    """
    stack = as_stack(images)
    t, curve = as_times(times, len(stack)), as_response(g, 256, stack[0, 0, 0].size)
    order = bracket.short_to_long(stack, t)
    Z, t = ranks(stack, as_mask(valid, stack))[:, order], t[order]
    error, darker_share = neighbour_errors(Z, t, curve)
    if np.any(darker_share > 0.5):
        raise CalibrationError(warning_text("darker", pair=_pair(t, darker_share)))
    measured = error[np.isfinite(error)]
    if np.any(measured > NEIGHBOUR_ERROR_LIMIT) or (
        len(measured) > 2 and np.median(measured) > MEDIAN_ERROR_LIMIT
    ):
        raise CalibrationError(warning_text("steep", pair=_pair(t, error), stops=measured.max()))
    low, high = INNER_LEVELS
    span = float(np.max(curve[high] - curve[low]) / np.log(2))
    if span > SPAN_LIMIT:
        raise CalibrationError(
            warning_text("wide", stops=span, low=low, high=high, widest=WIDEST_CAMERA)
        )
    return g


def _pair(t: F64, values: F64) -> str:
    j = int(np.nanargmax(values))
    return f"between {t[j]:.4g} s and {t[j + 1]:.4g} s"
