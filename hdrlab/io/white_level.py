"""Find the white level of 16-bit photos that do not use all 16 bits, and scale it to 65535.

Scientific cameras and RAW converters store 12 or 14 bits in 16-bit files: white is 4095 or 16383,
and not 65535. The format does not state it. In a bracket, the bright photos are clipped, so that
many pixels have exactly the white level and none is above it. A bracket in which no pixel is
clipped does not show its white level, and stays as it is.
"""

from dataclasses import dataclass

import numpy as np

from hdrlab.core.arrays import Array, Mask

FULL_WHITE = 65535
# A maximum from here on is the white of full 16 bits: the upper one of 256 levels.
MIN_FULL_MAXIMUM = 255 * 256
# White levels of integers with fewer bits.
WHITE_LEVELS_OF_BITS = {2**bits - 1: bits for bits in range(8, 16)}
# The maximum is a white level if this fraction of a photo's samples has it,
MIN_PILE_FRACTION = 0.0005
MIN_PILE_SAMPLES = 16
# and so many times as many as have a typical value just below it.
MIN_PILE_RATIO = 10.0
# Values just below the maximum, as a fraction of it.
NEIGHBORHOOD_FRACTION = 0.02
# A white level that is no 2^n - 1 needs several photos with different brightness.
MIN_CLIPPED_PHOTOS = 2
MIN_BRIGHTNESS_RATIO = 1.2


@dataclass(frozen=True)
class Pile:
    """The samples of a photo at the maximum of the whole bracket."""

    is_clear: bool
    brightness: float


def find_white_level(images: Array, *, valid: Mask | None = None) -> int | None:
    """Return the pixel value at which the photos of a bracket are clipped, if it is below 65535.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3) uint16
        All photos of the bracket.
    valid : (P, H, W) bool, optional
        False where a photo has no image.

    Returns
    -------
    int or None
        None for photos that use all 16 bits, and where no pixels pile up at the maximum.

    Examples
    --------
    >>> scene = np.linspace(0, 3000, 10_000).reshape(100, 100)
    >>> photos = [np.minimum(time * scene, 4095) for time in (1, 2, 4)]
    >>> find_white_level(np.uint16(photos))
    4095
    >>> find_white_level(np.uint16(photos[:1]))  # nothing is clipped
    """
    if images.dtype != np.uint16:
        return None
    white = 0
    for j, image in enumerate(images):
        samples = image if valid is None else image[valid[j]]
        white = max(white, int(samples.max(initial=0)))
        if white >= MIN_FULL_MAXIMUM:
            return None
    piles = []
    for j, image in enumerate(images):
        samples = image if valid is None else image[valid[j]]
        pile = _measure_pile(samples, white)
        if pile.is_clear:
            piles.append(pile)
    if white in WHITE_LEVELS_OF_BITS and piles:
        return white
    if len(piles) < MIN_CLIPPED_PHOTOS:
        return None
    darkest = min(pile.brightness for pile in piles)
    brightest = max(pile.brightness for pile in piles)
    return white if brightest > MIN_BRIGHTNESS_RATIO * darkest else None


def _measure_pile(samples: Array, white: int) -> Pile:
    """Return whether many more samples have the value `white` than a typical value just below."""
    count = np.count_nonzero(samples == white)
    brightness = float(samples.mean()) if samples.size else 0.0
    min_count = max(MIN_PILE_SAMPLES, MIN_PILE_FRACTION * samples.size)
    if count < min_count:
        return Pile(is_clear=False, brightness=brightness)
    width = max(1, round(NEIGHBORHOOD_FRACTION * white))
    near_count = np.count_nonzero(samples >= white - width) - count
    is_clear = bool(count > MIN_PILE_RATIO * near_count / width)
    return Pile(is_clear=is_clear, brightness=brightness)


def scale_to_full_white(images: Array, white: int) -> None:
    """Scale pixel values (P, H, W) or (P, H, W, 3) in place so that `white` becomes 65535."""
    values = np.arange(2**16)
    scaled = np.rint(np.minimum(values, white) * (FULL_WHITE / white)).astype(np.uint16)
    for image in images:
        np.take(scaled, image, out=image, mode="clip")


def describe_white_level(white: int) -> str:
    """Return a note on a white level that was found."""
    bits = WHITE_LEVELS_OF_BITS.get(white)
    kind = f", as in {bits}-bit data" if bits else ""
    return (
        f"no pixel of these 16-bit photos is above {white}, where many are clipped{kind}: "
        f"hdrlab takes {white} as white, instead of {FULL_WHITE}"
    )
