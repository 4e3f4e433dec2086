"""The difference of two median threshold bitmaps, as a figure: drag one bitmap over the other.

Y          gray photos (H, W) uint8
bits       of one photo at one level of the pyramid: (2, H, W) bool, bitmap and exclusion bitmap
offset     (dy, dx), how far the second bitmap is moved down and right, pixels of its level

The script counts the bits that differ as `align.mtb.error` does. A test compares the two.
"""

import zlib

import numpy as np
import traitlets

from hdrlab.align import mtb
from hdrlab.core import arrays
from hdrlab.core.arrays import Array, ArrayLike
from hdrlab.errors import InputError
from hdrlab.show.pictures import PLOT_PIXEL_DENSITY, Picture, encode, require_alt
from hdrlab.show.plots.lectures.bitmaps import difference
from hdrlab.show.widgets.scripts import Widget, script

# Larger photos make the figure slow, and the page heavy.
MAX_PHOTO_SIDE = 640


class BitmapDifference(Widget):
    """Two photos' bits at each level; `offset` (dy, dx) moves the second photo at `level`."""

    _esm = script("drag.js", "bitmaps.js")
    # Deflated bits of each level, the full size first: (2 photos, 2 bitmaps, H, W), packed.
    bits = traitlets.List(traitlets.Bytes()).tag(sync=True)
    sizes = traitlets.List(traitlets.List(traitlets.Int())).tag(sync=True)  # (H, W) of each level
    max_offset = traitlets.Int(20).tag(sync=True)  # pixels of the full size
    level = traitlets.Int(0).tag(sync=True)
    offset = traitlets.List(traitlets.Int()).tag(sync=True)
    is_excluding = traitlets.Bool(True).tag(sync=True)
    alt = traitlets.Unicode().tag(sync=True)
    picture = traitlets.Bytes().tag(sync=True)  # WebP, the difference without a shift

    def still(self) -> Picture:
        """Return the difference at the offset (0, 0)."""
        return Picture((self.picture,), (self.alt,), ("",), density=PLOT_PIXEL_DENSITY)


def bitmap_difference(
    fixed: ArrayLike, moving: ArrayLike, *, alt: str, max_offset: int = 20
) -> BitmapDifference:
    """Return a widget in which the bitmap of one photo is dragged over that of another.

    The bits that differ light up and are counted. A small map keeps the counts of all offsets that
    the reader tried.

    Parameters
    ----------
    fixed, moving : (H, W) or (H, W, 3) uint8 or uint16
        Two photos of one size, at most 640 pixels on a side. `moving` is dragged.
    alt : str
        What the photos show; the widget adds the offset.
    max_offset : int
        How far the bitmap can be moved in each direction, in pixels.

    Raises
    ------
    InputError
        For photos of different or too large sizes, a `max_offset` below 1, or an empty alt text.

    Examples
    --------
    >>> stripes = np.tile(np.array([20, 200], np.uint8), (32, 16))
    >>> bitmap_difference(stripes, stripes, alt="Stripes").sizes[0]
    [32, 32]
    """
    Y_fixed = _make_gray(fixed)
    Y_moving = _make_gray(moving)
    if Y_fixed.shape != Y_moving.shape or max(Y_fixed.shape) > MAX_PHOTO_SIDE:
        raise InputError(
            f"expected two photos of one size, at most {MAX_PHOTO_SIDE} pixels on a side, got "
            f"{arrays.describe(Y_fixed)} and {arrays.describe(Y_moving)}"
        )
    if max_offset < 1:
        raise InputError(f"expected max_offset of 1 pixel or more, got {max_offset}")
    levels = list(mtb.search(Y_fixed, Y_moving))[::-1]
    packed = []
    for state in levels:
        both = np.stack([state.fixed, state.moving])
        packed.append(zlib.compress(np.packbits(both, bitorder="little").tobytes()))
    still = difference(levels[0].fixed, levels[0].moving, (0, 0))
    return BitmapDifference(
        bits=packed,
        sizes=[list(state.fixed.shape[1:]) for state in levels],
        max_offset=max_offset,
        offset=[0, 0],
        alt=require_alt(alt),
        picture=encode(still, PLOT_PIXEL_DENSITY),
    )


def _make_gray(photo: ArrayLike) -> Array:
    """Return Y (H, W) uint8 of a photo, or raise an InputError."""
    photo = np.asarray(photo)
    is_photo = photo.ndim == 2 or (photo.ndim == 3 and photo.shape[2] == 3)
    if not is_photo or photo.dtype not in (np.uint8, np.uint16):
        raise InputError(
            f"expected a photo (H, W[, 3]) of 8 or 16 bits, got {arrays.describe(photo)}"
        )
    return mtb.gray(photo)
