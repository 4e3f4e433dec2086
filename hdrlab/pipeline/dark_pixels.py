"""Pixels that are black in every photo have no color.

Z   pixel values of a photo   (H, W, 3) uint8 or uint16
s   noise, in pixel values
c   color certainty           (H, W): 0 where no photo measures the color, 1 where one does
n   neutral color             (3,): of the unmeasured pixels, 1 in luminance

The ratios of three pixel values near 0 are noise, and the response of these values is hardly known.
So a night sky gets blue or violet blotches. The longest photo shows how well a dark pixel is
measured: its brightest channel over the noise. With less certainty, the pixel fades to gray of the
same luminance.

If all measured pixels have nearly one color, the gray has it, too. Photos of a gray wall whose white
balance is a little blue show blue gray, and sepia photos show brown. Next to these, a pixel with
equal channels would have another color.
"""

from collections.abc import Iterator

import numpy as np

from hdrlab.core.arrays import F32, Array, ArrayLike, Mask, as_mask, as_radiance, as_stack
from hdrlab.core.colour import luminance

# Up to this signal-to-noise ratio of its brightest channel, a pixel has no color.
MIN_SIGNAL_TO_NOISE = 2
# From this ratio on, it has all of its color.
FULL_SIGNAL_TO_NOISE = 10
# noise of 8-bit photos in pixel values; compression may hide it, and texture may look like it
MIN_NOISE_LEVELS = 1.0
MAX_NOISE_LEVELS = 2.0
# pixel values of 8-bit photos that are dark enough to show the noise
MAX_DARK_LEVEL = 16
# samples of a photo that are measured at a time, so that a large photo takes little memory
MAX_BAND_SAMPLES = 2**20
# side of the square whose mean value decides, in pixels
WINDOW_SIDE = 5
# standard deviation over median absolute deviation, of a normal distribution
DEVIATION_PER_MAD = 1.4826
# below this certainty a pixel counts as black in every photo
MAX_BLACK_CERTAINTY = 0.25
# Spread of the measured colors, in stops: up to the first one, they are one color, and the gray has
# it; from the second one on, the gray has equal channels.
ONE_COLOR_STOPS = 0.15
MANY_COLORS_STOPS = 0.3
# measured pixels, on an even grid, whose colors are compared
MAX_COLOR_SAMPLES = 2**16
# fraction of black pixels from which a longer exposure is missing
MIN_BLACK_FRACTION = 0.05


def measure_color_certainty(
    images: ArrayLike,
    times: ArrayLike,
    *,
    valid: ArrayLike | None = None,
    noise: float | None = None,
) -> F32 | None:
    """Return how certain the color of each pixel is, from 0 to 1.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint8 or uint16
    times : (P,)
        Exposure times in seconds.
    valid : (P, H, W) bool, optional
        False where a photo shows nothing of the scene.
    noise : float, optional
        What `measure_noise` returns for the longest photo, if it is known.

    Returns
    -------
    (H, W) float32 or None
        None if every pixel is bright enough in the longest photo.

    Raises
    ------
    InputError
        If the images are no stack of photos, or the mask has another shape.

    Examples
    --------
    >>> images = np.full((2, 9, 9, 3), 2, np.uint8)
    >>> images[1, :, 5:] = 200
    >>> measure_color_certainty(images, [1, 2])[4].tolist()
    [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    """
    stack = as_stack(images)
    mask = as_mask(valid, stack)
    longest = int(np.argmax(np.asarray(times)))
    photos = stack.reshape(*stack.shape[:3], -1)
    image = photos[longest]
    if noise is None:
        noise = measure_noise(image)
    full_level = int(np.ceil(FULL_SIGNAL_TO_NOISE * noise))
    certainty = np.ones(image.shape[:2], np.float32)
    for rows in split_rows(image):
        # Something that moved may be bright in another photo.
        band_mask = None if mask is None else mask[:, rows]
        is_dark = _find_largest(find_brightest(photos[:, rows], band_mask)) < full_level
        if mask is not None:
            is_dark &= mask[longest, rows]
        if not is_dark.any():
            continue
        signal_to_noise = _average_windows(image, rows)[is_dark] / np.float32(noise)
        span = FULL_SIGNAL_TO_NOISE - MIN_SIGNAL_TO_NOISE
        certainty[rows][is_dark] = np.clip((signal_to_noise - MIN_SIGNAL_TO_NOISE) / span, 0, 1)
    return None if np.all(certainty == 1) else certainty


def split_rows(image: Array) -> Iterator[slice]:
    """Yield the rows of bands of an image (H, W, C) that take little memory.

    Examples
    --------
    >>> list(split_rows(np.zeros((3, 2**18, 3))))
    [slice(0, 1, None), slice(1, 2, None), slice(2, 3, None)]
    """
    rows_per_band = max(1, MAX_BAND_SAMPLES // max(image[0].size, 1))
    for top in range(0, len(image), rows_per_band):
        yield slice(top, min(top + rows_per_band, len(image)))


def find_brightest(photos: Array, mask: Mask | None = None) -> Array:
    """Return the highest value (H, W, C) of each pixel in photos (P, H, W, C) that show it.

    It is 0 where the mask (P, H, W) is False in every photo.

    Examples
    --------
    >>> find_brightest(np.array([[[[3, 40]]], [[[5, 20]]]])).tolist()
    [[[5, 40]]]
    """
    if mask is None:
        return np.asarray(photos.max(axis=0))
    return np.asarray(photos.max(axis=0, where=mask[..., None], initial=0))


def _find_largest(image: Array) -> Array:
    """Return the largest channel (H, W) of an image (H, W, C)."""
    largest = image[..., 0]
    for channel in range(1, image.shape[2]):
        largest = np.maximum(largest, image[..., channel])
    return largest


def _average_windows(image: Array, rows: slice) -> F32:
    """Return the largest channel of the mean over the window around each pixel of some rows.

    The image (H, W, C) is continued beyond its edges.
    """
    height, width = image.shape[:2]
    margin = WINDOW_SIDE // 2
    around = np.clip(np.arange(rows.start - margin, rows.stop + margin), 0, height - 1)
    band_height = rows.stop - rows.start
    # Whole numbers are exact, and the largest sum of 16-bit values needs 21 bits.
    dtype = np.uint16 if image.dtype == np.uint8 else np.uint32
    largest = np.zeros((band_height, width), dtype)
    for channel in range(image.shape[2]):
        values = image[around, :, channel].astype(dtype)
        columns = np.zeros((band_height, width), dtype)
        for shift in range(WINDOW_SIDE):
            columns += values[shift : shift + band_height]
        padded = np.pad(columns, ((0, 0), (margin, margin)), mode="edge")
        total = np.zeros((band_height, width), dtype)
        for shift in range(WINDOW_SIDE):
            total += padded[:, shift : shift + width]
        np.maximum(largest, total, out=largest)
    return largest.astype(np.float32) / np.float32(WINDOW_SIDE**2)


def measure_black_fraction(certainty: ArrayLike) -> float:
    """Return the fraction of the image that is black in every photo."""
    return float(np.mean(np.asarray(certainty) < MAX_BLACK_CERTAINTY))


def measure_neutral(E: ArrayLike, certainty: ArrayLike) -> F32:
    """Return the color (3,) of the measured pixels, if they have one, else that of equal channels.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance.
    certainty : (H, W)
        See `measure_color_certainty`.

    Returns
    -------
    (3,) float32
        Its luminance is 1.

    Raises
    ------
    InputError
        If E is no radiance map.

    Examples
    --------
    >>> sepia = np.geomspace(1, 100, 64).reshape(8, 8, 1) * [1.2, 1, 0.8]
    >>> neutral = measure_neutral(sepia, np.ones((8, 8)))
    >>> (neutral / neutral[1]).round(2).tolist()
    [1.2000000476837158, 1.0, 0.800000011920929]
    """
    radiance = as_radiance(E)
    equal_channels = np.ones(3, np.float32)
    if radiance.ndim == 2:
        return equal_channels
    step = max(1, int(np.sqrt(radiance[..., 0].size / MAX_COLOR_SAMPLES)))
    sample = radiance[::step, ::step]
    is_certain = np.asarray(certainty)[::step, ::step] == 1
    measured = sample[is_certain & np.all(sample > 0, axis=-1)]
    if not len(measured):
        return equal_channels
    log_ratios = np.log2(measured / measured[:, 1:2])
    low, median, high = np.percentile(log_ratios, [16, 50, 84], axis=0)
    spread = float(np.max(high - low)) / 2
    span = MANY_COLORS_STOPS - ONE_COLOR_STOPS
    color_weight = np.clip((MANY_COLORS_STOPS - spread) / span, 0, 1)
    color = (2 ** (color_weight * median)).astype(np.float32)
    return color / luminance(color[None, None])[0, 0]


def fade_to_neutral(
    E: ArrayLike,
    certainty: ArrayLike,
    *,
    neutral: ArrayLike = (1, 1, 1),
    in_place: bool = False,
) -> F32:
    """Return the map in which uncertain pixels are gray, with the same luminance.

    Parameters
    ----------
    E : (H, W) or (H, W, 3)
        Radiance.
    certainty : (H, W)
        See `measure_color_certainty`.
    neutral : (3,)
        Color of gray, with a luminance of 1; see `measure_neutral`.
    in_place : bool
        Whether E, an array of float32, may be overwritten, which saves a copy of it.

    Returns
    -------
    (H, W) or (H, W, 3) float32

    Raises
    ------
    InputError
        If E is no radiance map.

    Examples
    --------
    >>> fade_to_neutral([[[0.5, 0.5, 4.0]]], [[1.0]]).tolist()
    [[[0.5, 0.5, 4.0]]]
    >>> faded = fade_to_neutral([[[0.5, 0.5, 4.0]]], [[0.0]])
    >>> bool(np.ptp(faded) < 1e-6)
    True
    """
    radiance = as_radiance(E)
    if radiance.ndim == 2 or np.all(np.asarray(certainty) == 1):
        return radiance
    faded = radiance if in_place else radiance.copy()
    for rows in split_rows(faded):
        color_weight = np.asarray(certainty, np.float32)[rows]
        is_uncertain = color_weight < 1
        if not is_uncertain.any():
            continue
        colored = faded[rows][is_uncertain]
        gray = luminance(colored[None])[0][:, None] * np.asarray(neutral, np.float32)
        faded[rows][is_uncertain] = gray + color_weight[is_uncertain][:, None] * (colored - gray)
    return faded


def measure_noise(image: ArrayLike) -> float:
    """Return the noise of the dark pixels of a photo, in pixel values.

    Parameters
    ----------
    image : (H, W) or (H, W, C) uint8 or uint16

    Examples
    --------
    >>> measure_noise(np.full((4, 6, 3), 200, np.uint8))  # no dark pixels
    1.0
    """
    image = np.asarray(image)
    is_byte = image.dtype == np.uint8
    dark_level = MAX_DARK_LEVEL if is_byte else 257 * MAX_DARK_LEVEL
    counts = np.zeros(dark_level, np.int64)
    for rows in split_rows(image):
        counts += _count_dark_differences(image[rows], dark_level)
    if not counts.any():
        return MIN_NOISE_LEVELS
    noise = DEVIATION_PER_MAD * _median_of_counts(counts) / np.sqrt(2)
    most = MAX_NOISE_LEVELS if is_byte else 257 * MAX_NOISE_LEVELS
    return float(np.clip(noise, MIN_NOISE_LEVELS, most))


def _count_dark_differences(image: Array, dark_level: int) -> Array:
    """Return how many dark neighbors in the rows of an image differ by 0, 1, ... pixel values."""
    left = image[:, :-1]
    right = image[:, 1:]
    low = np.minimum(left, right)
    high = np.maximum(left, right)
    is_dark = (high < dark_level) & (low > 0)
    differences = high[is_dark] - low[is_dark]
    return np.bincount(differences.astype(np.intp), minlength=dark_level)


def _median_of_counts(counts: Array) -> float:
    """Return the median of numbers of which counts[k] are k."""
    cumulative = np.cumsum(counts)
    number = int(cumulative[-1])
    # Of an even number of values, the mean of the two in the middle.
    middle = np.searchsorted(cumulative, [(number - 1) // 2, number // 2], side="right")
    return float(middle.mean())
