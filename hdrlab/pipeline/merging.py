"""Merge photos, and let the longest one limit what is dark in all of them.

Z      pixel values of the longest photo      (H, W, C) uint8 or uint16
delta  how far noise may lift a pixel value   in pixel values
E      radiance                               (H, W, C), at most exp(g(Z + delta)) / t

A merge weights a pixel by its value. In a dark part that is wrong: a short photo in which noise or
compression lifted a pixel from 0 to 3 counts more than one without noise, and it claims the radiance
of a bright pixel. If the longest photo shows 0 there, it has no weight at all, although it says
most: the pixel is darker than the smallest value in the longest time. So a dark wall got bright dots,
and dark colors turned gray. The longest photo collected the most light. Up to its noise, it is an
upper limit.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hdrlab.core.arrays import (
    F32,
    F64,
    Array,
    ArrayLike,
    Indices,
    Mask,
    as_mask,
    as_response,
    as_stack,
    levels,
)
from hdrlab.fast.merge import merge_with_quality
from hdrlab.pipeline import dark_pixels
from hdrlab.radiance.merge import Merged, Quality

if TYPE_CHECKING:
    # it imports scipy.optimize, which a merge does not need
    from hdrlab.diagnostics.noise import Noise

# pixel values of 8-bit photos below which noise decides what a short photo shows
MAX_DARK_LEVEL = 16
# how far noise may lift a pixel value, in standard deviations
NOISE_DEVIATIONS = 2.0
# photos whose times are within this factor of the longest one count as longest, too
LONGEST_FACTOR = 1.2
# methods of the merge that know that a long exposure measures dark pixels better
LIMITED_METHODS = ("shot", "likelihood")


class _DarkBand(NamedTuple):
    """Rows of a bracket, and the values (h, W, C) that the longest photo shows in dark pixels."""

    rows: slice
    values: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class MergeRecord:
    """How the pixels of a map were merged, so that each of them can be merged and explained again.

    Attributes
    ----------
    method : str
        See `merge_photos`.
    pixel_weights : (n,)
        Weights of the pixel values.
    noise : float
        See `merge_photos`.
    certainty : (h, w) float32 or None
        How certain the color of each pixel is, see `dark_pixels.measure_color_certainty`.
    neutral : (3,)
        The color to which uncertain pixels faded.
    used : (P, h, w) bool or None
        The photos that make each pixel, if ghosts were removed; None if these are all that show it.
    references : (R,) int or None
        The reference photo of each region that moved.
    alpha : (h, w) float32 or None
        How much of a pixel is made of `used`, see `radiance.deghosting.ghosts.Ghosts`.
    sensor_noise : Noise or None
        Noise of the camera, if it was estimated from the photos.
    unit_factor : float
        What the map was multiplied by after the merge, see `stages.calibrate`.
    """

    method: str
    pixel_weights: F64
    noise: float
    certainty: F32 | None
    neutral: F32
    used: Mask | None = None
    references: Indices | None = None
    alpha: F32 | None = None
    sensor_noise: "Noise | None" = None
    unit_factor: float = 1.0


def merge_photos(
    images: ArrayLike,
    times: ArrayLike,
    g: ArrayLike,
    w: ArrayLike | None = None,
    *,
    method: str,
    noise: float,
    valid: ArrayLike | None = None,
    repair: bool = True,
) -> Merged:
    """Return the radiance map and the quality flags of its pixels.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
        Aligned photos. The memory of `fast.merge.Expendable` photos is given back.
    times : (P,) float
        Exposure times in seconds.
    g : (n,) or (n, 3)
        Response, ln exposure of each pixel value.
    w : (n,), optional
        Weights of the pixel values.
    method : {"log", "likelihood", "mean", "shot"}
        See `radiance.merge`. With "log" and "mean", which do not look at the exposure times, the
        longest photo is no limit.
    noise : float
        Standard deviation of dark pixels in the longest photo, in pixel values; see
        `dark_pixels.measure_noise`.
    valid : (P, H, W) bool, optional
        False where a photo shows nothing of the scene.
    repair : bool
        Whether to repair stuck pixels.

    Raises
    ------
    InputError
        If the arrays do not fit together, or the method is unknown.

    Examples
    --------
    >>> g = np.log(np.maximum(np.arange(256), 0.5))  # a linear camera
    >>> images = np.array([[[3, 40]], [[0, 160]]], np.uint8)  # the first pixel of 3 is noise
    >>> merge_photos(images, [1, 4], g, method="shot", noise=1).E.tolist()
    [[0.5, 40.0]]
    """
    if method not in LIMITED_METHODS:
        return merge_with_quality(images, times, g, w, method=method, repair=repair, valid=valid)
    stack = as_stack(images)
    mask = as_mask(valid, stack)
    # The dark pixels are found first, because the merge may free the photos.
    bands, time = _find_dark(stack, np.asarray(times, np.float64), mask)
    merged = merge_with_quality(images, times, g, w, method=method, repair=repair, valid=valid)
    E = merged.E.reshape(*stack.shape[1:3], -1)
    curves = as_response(g, levels(stack), E.shape[-1])
    delta = max(1, round(NOISE_DEVIATIONS * noise))
    limits = np.exp(curves[delta:]).astype(np.float32) / np.float32(time)
    limits[_dark_level(stack)] = np.inf  # pixels that are not dark have this value
    for band in bands:
        is_kept = merged.quality[band.rows] & Quality.STUCK == 0
        for channel, channel_limits in enumerate(limits.T):
            radiance = E[band.rows, :, channel]
            band_limits = channel_limits.take(band.values[..., channel])
            np.minimum(radiance, band_limits, out=radiance, where=is_kept)
    return merged


def _dark_level(stack: Array) -> int:
    """Return the lowest pixel value that is not dark."""
    return MAX_DARK_LEVEL if stack.dtype == np.uint8 else 257 * MAX_DARK_LEVEL


def _find_dark(stack: Array, times: Array, mask: Mask | None) -> tuple[list[_DarkBand], float]:
    """Return the rows with pixels that are dark in all photos, and the time of the longest photo.

    A pixel that is dark only in the longest photo moved, or the photo is damaged.
    """
    dark_level = _dark_level(stack)
    photos = stack.reshape(*stack.shape[:3], -1)
    is_longest = times * LONGEST_FACTOR >= times.max()
    bands = []
    for rows in dark_pixels.split_rows(photos[0]):
        band_mask = None if mask is None else mask[:, rows]
        brightest = dark_pixels.find_brightest(photos[:, rows], band_mask)
        is_dark = brightest < dark_level
        if band_mask is not None:
            is_dark &= band_mask[is_longest].all(axis=0)[..., None]
        if is_dark.any():
            values = dark_pixels.find_brightest(photos[is_longest, rows])
            bands.append(_DarkBand(rows, np.where(is_dark, values, values.dtype.type(dark_level))))
    return bands, float(times[is_longest].min())
