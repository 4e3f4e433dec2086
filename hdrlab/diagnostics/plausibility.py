"""Is a response consistent with its photographs? If not, times or frames are grossly wrong.

images  photographs   (P, H, W[, 3])
t       times         (P,) seconds, as stated
Z       ranks         (N, P, C), levels of equal rank in every frame: see `core.sampling.by_rank`
g       response      (256,) or (256, 3), ln exposure of each level
error   stops         (P - 1,), median size of g(Z_j+1) - g(Z_j) - ln t_j+1 / t_j

Least squares gives a curve for any input. Three things show that no camera has this curve: a longer
exposure that is darker; neighbours that even the curve leaves several stops apart; and a curve that
spans more stops than any camera's, which is how two frames with a wrong ratio explain each other.

The limits are wide. Times that are off by a stop or two give a curve, and the map gets a warning,
see `contradictions`. Times that are off by a factor of 100 give an error, with one exception: a
linear camera with stated ratios of 400 instead of 4 looks like a camera with a gamma of 4.3, which
its photos cannot rule out.
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
from hdrlab.diagnostics.warning_texts import warning_text
from hdrlab.errors import CalibrationError

# stops between neighbours; a bracket with wrong times that is still worth a map comes to 1.8
NEIGHBOUR_ERROR_LIMIT = 4.0
# stops, where half of three pairs or more are off by so much
MEDIAN_ERROR_LIMIT = 3.0
# levels by which equal ranks may differ, even where two histograms are one
RANK_NOISE = 2
# levels away from shoulder and toe, where scanned film has a floor, and the curve a cliff
LOW_INNER_LEVEL = 30
HIGH_INNER_LEVEL = 225
# stops between the inner levels, of 201 measured curves and of our formulas
WIDEST_CAMERA = 10.2
# stops there; stated times that were off by a stop or two made a bracket's curve span 12.3
SPAN_LIMIT = 13.0
# number of ranks
RANK_COUNT = 1000
# ranks that two frames must both measure to be compared
MIN_COMMON_RANKS = 30
# about this number of pixels of a frame is used, on an even grid
MAX_PIXELS = 2**16


def ranks(stack: Array, valid: Mask | None) -> Indices:
    """Return the levels of equal rank Z (N, P, C) of pixels on an even grid."""
    step = max(1, int(np.sqrt(stack.shape[1] * stack.shape[2] / MAX_PIXELS)))
    sample = stack[:, ::step, ::step]
    mask = None if valid is None else valid[:, ::step, ::step]
    if mask is not None and not mask.all(axis=0).any():
        mask = None
    Z = sampling.by_rank(sample, RANK_COUNT, valid=mask)
    return Z.reshape(*Z.shape[:2], -1)


def neighbour_errors(Z: Indices, t: F64, g: F64) -> tuple[F64, F64]:
    """Return the error of each pair of neighbours, and how often the longer exposure is darker.

    Both are (P - 1,), for times t in ascending order. NaN where two frames have too few common
    ranks between the levels 10 and 250, or the same time.
    """
    channels = np.arange(Z.shape[-1])
    time_steps = np.diff(np.log(t))
    error = np.full(len(time_steps), np.nan)
    darker_fraction = np.full(len(time_steps), np.nan)
    for j in np.flatnonzero(time_steps > 0):
        pair = Z[:, j : j + 2]
        in_range = (pair >= metrics.LOW_LEVEL) & (pair <= metrics.HIGH_LEVEL)
        in_both = in_range.all(axis=1)
        if in_both.sum() < MIN_COMMON_RANKS:
            continue
        g_steps = np.diff(g[pair, channels], axis=1)[:, 0]
        stops = np.abs(g_steps - time_steps[j]) / np.log(2)
        is_darker = np.diff(pair, axis=1)[:, 0] < -RANK_NOISE
        error[j] = np.median(stops[in_both])
        darker_fraction[j] = np.mean(is_darker[in_both])
    return error, darker_fraction


def validate_response(
    g: F64, images: ArrayLike, times: ArrayLike, *, valid: ArrayLike | None = None
) -> F64:
    """Return g, or raise a CalibrationError if the photos contradict it.

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
    CalibrationError
        If a longer exposure is the darker one, if two neighbours are off by more than 4 stops, or
        half of them by more than 3, or if the curve spans more than 13 stops.

    Examples
    --------
    >>> g = np.log(np.maximum(np.arange(256), 0.25) / 128)  # a linear camera
    >>> images = np.stack([np.arange(20, 84), np.arange(40, 168, 2)]).astype(np.uint8)
    >>> images = images.reshape(2, 8, 8)
    >>> validate_response(g, images, [1, 2]) is g
    True
    >>> validate_response(g, images, [1, 200])  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    hdrlab.errors.CalibrationError: the exposure times contradict the images: ...
    """
    stack = as_stack(images)
    t = as_times(times, len(stack))
    curve = as_response(g, 256, stack[0, 0, 0].size)
    order = bracket.short_to_long(stack, t)
    t = t[order]
    Z = ranks(stack, as_mask(valid, stack))[:, order]
    error, darker_fraction = neighbour_errors(Z, t, curve)
    if np.any(darker_fraction > 0.5):
        raise CalibrationError(warning_text("darker", pair=_describe_worst(t, darker_fraction)))
    measured = error[np.isfinite(error)]
    has_wrong_pair = np.any(measured > NEIGHBOUR_ERROR_LIMIT)
    has_many_wrong_pairs = len(measured) > 2 and np.median(measured) > MEDIAN_ERROR_LIMIT
    if has_wrong_pair or has_many_wrong_pairs:
        worst = _describe_worst(t, error)
        raise CalibrationError(warning_text("steep", pair=worst, stops=measured.max()))
    span = float(np.max(curve[HIGH_INNER_LEVEL] - curve[LOW_INNER_LEVEL]) / np.log(2))
    if span > SPAN_LIMIT:
        message = warning_text(
            "wide", stops=span, low=LOW_INNER_LEVEL, high=HIGH_INNER_LEVEL, widest=WIDEST_CAMERA
        )
        raise CalibrationError(message)
    return g


def _describe_worst(t: F64, values: F64) -> str:
    """Return the times of the pair with the largest value, as a warning shows them."""
    j = int(np.nanargmax(values))
    return f"between {t[j]:.4g} s and {t[j + 1]:.4g} s"
