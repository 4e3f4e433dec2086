"""Consistency of the map with its photographs.

Z   pixel levels       (P, H, W[, 3])
t   exposure times     (P,) seconds
E   radiance           (H, W[, 3])

A pixel of level z received the exposure f^-1(z), in whichever frame it is. So for each level the
median of log2(E t) over the pixels of that level must be the same in every frame. Where it is not,
the times, the response or the alignment contradict the pixels. The functions here measure by how
many stops, for each frame.
"""

import numpy as np

from hdrlab.core import arrays
from hdrlab.core.arrays import F32, F64, ArrayLike, Flags, Labels, Mask
from hdrlab.core.silence import ignore_library_warnings
from hdrlab.errors import InputError

# away from the noise below and the shoulder above
LEVELS = slice(30, 226)
# away from clipping, and from levels that are mostly noise
WIDE_LEVELS = slice(10, 251)
# about this number of pixels of a frame is used, on an even grid
MAX_PIXELS = 400_000
# a pixel with a channel above this level is clipped, and not a measurement
MAX_LEVEL = 250
# pixels of a level without which it has no median
MIN_PIXELS_PER_LEVEL = 50


def measure_level_exposures(
    images: ArrayLike, times: ArrayLike, E: ArrayLike, *, valid: ArrayLike | None = None
) -> F64:
    """Return the median of log2(E t) of each frame, channel and level, (P, C, 256).

    NaN where a level has too few pixels.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
    times : (P,) seconds
    E : (H, W) or (H, W, 3), the map that was made of them; pixels that are 0 are left out
    valid : (P, H, W) bool, False where a photograph holds no picture

    Raises
    ------
    InputError
        If the shapes of photographs, map and mask do not fit together.

    Examples
    --------
    >>> Z = np.repeat(np.uint8([[64, 128]]), 200, axis=0)
    >>> E = Z / 128  # a linear camera, two photographs of one second
    >>> measure_level_exposures([Z, Z], [1, 1], E)[:, 0, [64, 128]]
    array([[-1.,  0.],
           [-1.,  0.]])
    """
    stack = arrays.as_stack(images)
    E = arrays.as_radiance(E)
    times = arrays.as_times(times, len(stack))
    mask = arrays.as_mask(valid, stack)
    if E.shape != stack.shape[1:]:
        raise InputError(f"expected a map of shape {stack.shape[1:]}, got {E.shape}")
    rows, columns = choose_grid(E.shape)
    channel_count = 1 if E.ndim == 2 else E.shape[-1]
    orders = []
    log_radiances = []
    for radiance in E[rows, columns].reshape(-1, channel_count).T:
        # sort once for all frames, without the pixels that are 0
        ascending = np.argsort(radiance)[np.count_nonzero(radiance == 0) :]
        orders.append(ascending)
        log_radiances.append(np.log2(radiance.take(ascending)))
    medians = np.empty((len(stack), channel_count, 256))
    for j, image in enumerate(stack):
        Z = arrays.to_256(image[rows, columns]).reshape(-1, channel_count).T.copy()
        is_measured: Mask = np.all(Z <= MAX_LEVEL, axis=0)
        if mask is not None:
            is_measured &= mask[j, rows, columns].ravel()
        np.copyto(Z, 255, where=~is_measured)  # a level beyond MAX_LEVEL, which has no median
        for c, levels in enumerate(Z):
            median = _median_per_level(levels.take(orders[c]), log_radiances[c])
            medians[j, c] = median + np.log2(times[j])
    medians[..., MAX_LEVEL + 1 :] = np.nan
    return medians


def find_measured_levels(medians: F64, n: int = 256) -> Labels:
    """Return the first and the last pixel value that occurs in each channel, (C, 2), of n values.

    Only values up to MAX_LEVEL of 256 count, in well exposed pixels. A channel without any gets 0
    and n - 1. A response is not determined outside of these values: below the black floor of a
    scanner, for example, it is an extrapolation.

    Examples
    --------
    >>> medians = np.full((2, 1, 256), np.nan)
    >>> medians[1, 0, 19:240] = 0
    >>> find_measured_levels(medians).tolist()
    [[19, 239]]
    """
    occurs: Mask = np.any(np.isfinite(medians), axis=0)
    first = occurs.argmax(axis=1)
    last = occurs.shape[1] - 1 - occurs[:, ::-1].argmax(axis=1)
    scale = (n - 1) / (occurs.shape[1] - 1)
    return np.rint(np.column_stack([first, last]) * scale).astype(np.int32)


def choose_grid(shape: tuple[int, ...]) -> tuple[slice, slice]:
    """Return the rows and columns of an even grid of about MAX_PIXELS over an image (H, W[, 3])."""
    step = max(1, int(np.sqrt(shape[0] * shape[1] / MAX_PIXELS)))
    return np.s_[::step, ::step]


def _median_per_level(Z: Flags, lE: F32) -> F64:
    """Return the median of the ascending lE over the pixels of each level, (256,)."""
    order = np.argsort(Z, kind="stable")
    count = np.bincount(Z, minlength=256)
    first = np.cumsum(count) - count
    is_enough = count >= MIN_PIXELS_PER_LEVEL
    low = order[(first + (count - 1) // 2)[is_enough]]
    high = order[(first + count // 2)[is_enough]]
    medians = np.full(256, np.nan)
    medians[is_enough] = (lE[low] + lE[high]) / 2
    return medians


def measure_deviations(medians: F64) -> F64:
    """Return by how many stops each frame departs from the mean of all, (P,).

    The median over levels and channels; NaN for a frame that shares no level with another.
    """
    with ignore_library_warnings():  # a level that no frame shows has no mean
        apart = medians - np.nanmean(_keep_shared(medians), axis=0)
        return np.nanmedian(apart[..., LEVELS].reshape(len(medians), -1), axis=1)


def measure_residuals(medians: F64, g: ArrayLike) -> F64:
    """Return the residuals of g and the times, (P, C, 256) stops.

    They are 0 if g and the times describe the camera. A frame that is off as a whole has a wrong
    time. A level that is off in all frames shows a wrong g. A level that is off differently in each
    frame shows a camera that processes each photo differently. Where two frames contradict each
    other by a stop, each has a part of it, because both contribute to E.

    Examples
    --------
    >>> g = np.log(np.maximum(np.arange(256), 0.5) / 128)
    >>> medians = np.stack([g / np.log(2), g / np.log(2) - 1])[:, None]  # the second is a stop off
    >>> measure_residuals(medians, g)[:, 0, 64].tolist()
    [0.0, 1.0]
    """
    return arrays.as_response(g, 256, medians.shape[1]).T / np.log(2) - medians


def measure_spread(medians: F64) -> float:
    """Return the spread of the map in stops.

    The standard deviation over the frames, and its median over levels and channels. 0 means that
    the frames are consistent, NaN that no level occurs in two frames.

    Examples
    --------
    >>> measure_spread(np.zeros((3, 1, 256)))  # three frames that agree on every level
    0.0
    """
    with ignore_library_warnings():
        return float(np.nanmedian(np.nanstd(_keep_shared(medians), axis=0)[..., LEVELS]))


def measure_rms_spread(medians: F64) -> float:
    """Return the root mean square of the spread over levels and channels, in stops.

    `measure_spread` hides a response that is wrong for some levels or in one channel, because it
    is a median. This one also looks at darker and brighter levels. NaN if no level occurs in two
    frames.

    Examples
    --------
    >>> medians = np.zeros((2, 3, 256))
    >>> medians[1, 2] = 2  # the frames contradict each other in blue
    >>> measure_spread(medians), round(measure_rms_spread(medians), 3)
    (0.0, 0.577)
    """
    with ignore_library_warnings():
        variances = np.nanvar(_keep_shared(medians), axis=0)[..., WIDE_LEVELS]
        return float(np.sqrt(np.nanmean(variances)))


def _keep_shared(medians: F64) -> F64:
    """Return the medians of the levels that at least two frames show; NaN elsewhere."""
    return np.where(np.isfinite(medians).sum(axis=0) >= 2, medians, np.nan)
