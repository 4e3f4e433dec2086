"""Consistency of the map with its photographs.

Z   pixel levels       (P, H, W[, 3])
t   exposure times     (P,) seconds
E   radiance           (H, W[, 3])

A pixel of level z received the exposure f^-1(z), whichever frame it stands in. So for each level
the median of log2(E t) over the pixels of that level must be the same in every frame. Where it is
not, the times, the response or the alignment contradict the pixels; in photographic stops, and
frame by frame.
"""

import warnings

import numpy as np

from hdrlab.core import arrays
from hdrlab.core.arrays import F32, F64, ArrayLike, Flags, Mask
from hdrlab.errors import InputError

# away from the noise below and the shoulder above
LEVELS = slice(30, 226)
# an even choice of about so many represents the whole frame
PIXELS = 400_000
# a frame's pixel with a channel above is clipped, and not a measurement
TOP = 250
# pixels that make a median
FEWEST = 50


def measure_level_exposures(
    images: ArrayLike, times: ArrayLike, E: ArrayLike, *, valid: ArrayLike | None = None
) -> F64:
    """Return the median of log2(E t) per frame, channel and level, (P, C, 256); NaN where pixels are few.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
    times : (P,) seconds
    E : (H, W) or (H, W, 3), the map that was made of them; pixels that are 0 are left out
    valid : (P, H, W) bool, False where a photograph holds no picture

    Raises
    ------
    ValueError
        If the shapes of photographs, map and mask do not fit together.

    Examples
    --------
    >>> Z = np.repeat(np.uint8([[64, 128]]), 200, axis=0)
    >>> E = Z / 128  # a linear camera, two photographs of one second
    >>> measure_level_exposures([Z, Z], [1, 1], E)[:, 0, [64, 128]]
    array([[-1.,  0.],
           [-1.,  0.]])
    """
    stack, E = arrays.as_stack(images), arrays.as_radiance(E)
    times, mask = arrays.as_times(times, len(stack)), arrays.as_mask(valid, stack)
    if E.shape != stack.shape[1:]:
        raise InputError(f"expected a map of shape {stack.shape[1:]}, got {E.shape}")
    few, channels = choose_grid(E.shape), 1 if E.ndim == 2 else E.shape[-1]
    Z = np.moveaxis(arrays.to_256(stack[:, *few]).reshape(len(stack), -1, channels), -1, 0).copy()
    whole: Mask = np.all(Z <= TOP, axis=0)
    if mask is not None:
        whole &= mask[:, *few].reshape(len(stack), -1)
    np.copyto(Z, 255, where=~whole)  # a level beyond TOP, which has no median
    medians = np.empty((len(stack), channels, 256))
    for c, light in enumerate(E[few].reshape(-1, channels).T):
        rising = np.argsort(light)[np.count_nonzero(light == 0) :]  # once for all frames
        lE = np.log2(light.take(rising))
        for j, levels in enumerate(Z[c]):
            medians[j, c] = _median_per_level(levels.take(rising), lE) + np.log2(times[j])
    medians[..., TOP + 1 :] = np.nan
    return medians


def choose_grid(shape: tuple[int, ...]) -> tuple[slice, slice]:
    """Return the rows and columns of a picture (H, W[, 3]) that stand for all of it, about PIXELS places."""
    step = max(1, int(np.sqrt(shape[0] * shape[1] / PIXELS)))
    return np.s_[::step, ::step]


def _median_per_level(Z: Flags, lE: F32) -> F64:
    """Return the median of lE, which rises, over the pixels of each level, (256,)."""
    order, count = np.argsort(Z, kind="stable"), np.bincount(Z, minlength=256)
    first, enough = np.cumsum(count) - count, count >= FEWEST
    low, high = (order[(first + half)[enough]] for half in ((count - 1) // 2, count // 2))
    medians = np.full(256, np.nan)
    medians[enough] = (lE[low] + lE[high]) / 2
    return medians


def measure_deviations(medians: F64) -> F64:
    """Return by how many stops each frame departs from the mean of all (P,): median over levels, channels.

    NaN for a frame that shares no level with another: nothing is known of it.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # a level that no frame shows has no mean
        apart = medians - np.nanmean(_keep_shared(medians), axis=0)
        return np.nanmedian(apart[..., LEVELS].reshape(len(medians), -1), axis=1)


def measure_residuals(medians: F64, g: ArrayLike) -> F64:
    """Return what g and the times leave unexplained of each frame, channel and level, (P, C, 256) stops.

    All are 0 where the camera is the one that g and the times describe. A frame that lies off as a
    whole has a wrong time; a level that lies off in all frames, a wrong g; a level that lies off
    differently from frame to frame belongs to a camera that treats each photograph in its own way.
    Where two frames contradict each other by a stop, each shows a part of it, for both have a share
    in E.

    Examples
    --------
    >>> g = np.log(np.maximum(np.arange(256), 0.5) / 128)
    >>> medians = np.stack([g / np.log(2), g / np.log(2) - 1])[:, None]  # the second lies off by a stop
    >>> measure_residuals(medians, g)[:, 0, 64].tolist()
    [0.0, 1.0]
    """
    return arrays.as_response(g, 256, medians.shape[1]).T / np.log(2) - medians


def measure_spread(medians: F64) -> float:
    """Return the map's spread in stops: standard deviation over the frames, median over levels and channels.

    0 means that the frames are consistent; NaN that no level occurs in two frames.

    Examples
    --------
    >>> measure_spread(np.zeros((3, 1, 256)))  # three frames that agree on every level
    0.0
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        return float(np.nanmedian(np.nanstd(_keep_shared(medians), axis=0)[..., LEVELS]))


def _keep_shared(medians: F64) -> F64:
    """Return the medians of the levels that at least two frames show; NaN elsewhere."""
    return np.where(np.isfinite(medians).sum(axis=0) >= 2, medians, np.nan)
