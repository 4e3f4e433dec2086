"""Moving photographs by fractions of pixels: through linear light, and cut to what all of them show.

H      (P, 3, 3)        where pixel (x, y, 1) of photograph j lies in the common picture, see `filters.warp`
g      (n,) or (n, 3)   response, ln exposure of each level
Z, X   level, light     X = exp g(Z)

A pixel between pixels is a mean of light, not of levels. So a photograph is linearized by g,
resampled, and written with g again: the result is a photograph of the same camera. Where light is
even, any g leaves the level as it is; at edges a slightly wrong g errs slightly. So a provisional
response is enough, such as the one from the histograms of photographs that are not aligned.

Clipped pixels do not measure light. Where a mean would contain one, the nearest pixel is copied.
"""

from collections.abc import Sequence

import numpy as np
import scipy

from hdrlab.align.light import SATURATED_FRACTION
from hdrlab.core.arrays import F64, Array, ArrayLike, Mask, as_mask, as_stack, as_table, levels
from hdrlab.core.colour import decode_srgb
from hdrlab.core.filters import warp

# The common picture is resampled in bands of this many rows, which bounds the memory.
BAND_ROWS = 256


def photographs(
    images: ArrayLike,
    homographies: ArrayLike,
    g: ArrayLike | None = None,
    *,
    valid: ArrayLike | None = None,
) -> tuple[Array, Mask | None]:
    """Return the images moved and cropped to the part that all of them show, and their masks.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
    homographies : (P, 3, 3), or offsets (P, 2)
        As `cerman.align` and `homography.align` return them. An image that moves by whole pixels is
        cut out as it is.
    g : (n,) or (n, 3), optional
        A response; by default that of sRGB.
    valid : (P, H, W) bool, optional
        False where an image holds no picture. A moved pixel is invalid if its mean contains an
        invalid one.

    Returns
    -------
    moved : (P, h, w) or (P, h, w, 3), of the images' dtype
    valid : (P, h, w) bool, or None

    Raises
    ------
    ValueError
        For homographies that do not fit the images, or leave nothing in common.

    Examples
    --------
    >>> images = np.array([[[10, 10, 200, 200]], [[10, 10, 200, 200]]], np.uint8)
    >>> photographs(images, [[0, 0.5], [0, 0]])[0].tolist()  # between 10 and 200 lies 147, not 105
    [[[10, 147, 200]], [[10, 200, 200]]]
    """
    images = as_stack(images)
    H = warp.as_homographies(homographies, len(images))
    masks = as_mask(valid, images)
    shown = warp.common_rectangle(H, images.shape[1:3])
    table = _light_table(g, levels(images), images[0, 0, 0].size)
    rows, columns = shown
    size = (rows.stop - rows.start, columns.stop - columns.start)
    moved = np.empty((len(images), *size, *images.shape[3:]), images.dtype)
    for j, image in enumerate(images):
        moved[j] = move_image(image, H[j], shown, table)
    if masks is None:
        return moved, None
    moved_masks = [_move_mask(mask, mask_H, shown) for mask, mask_H in zip(masks, H, strict=True)]
    return moved, np.stack(moved_masks)


def move_image(image: Array, H: F64, shown: tuple[slice, slice], table: F64) -> Array:
    """Return the rectangle `shown` of an image moved by H; `table` (n, C) is the light of each level."""
    offset = _whole_offset(H)
    if offset is not None:
        return cut(image, offset, shown)
    planes = image.reshape(*image.shape[:2], -1)
    back, size = _inverse(H, shown)
    moved = np.empty((*size, planes.shape[2]), image.dtype)
    n = len(table)
    light = table.astype(np.float32)
    for top in range(0, len(moved), BAND_ROWS):
        band = moved[top : top + BAND_ROWS]
        part, to_part = _source_part(planes, back @ warp.as_homographies([[top, 0]])[0], band.shape)
        mean = warp.sample(light[part, np.arange(part.shape[2])], to_part, band.shape)
        for c in range(part.shape[2]):
            band[..., c] = np.interp(mean[..., c], table[:, c], np.arange(n)) + 0.5
        clipped = _touched(part >= round(SATURATED_FRACTION * (n - 1)), to_part, band.shape)
        np.copyto(band, warp.nearest(part, to_part, band.shape), where=clipped)
    return moved.reshape(*size, *image.shape[2:])


def _source_part(image: Array, back: F64, size: tuple[int, ...]) -> tuple[Array, F64]:
    """Return the part of an image that cubic means at `back` p, p of (h, w), need, and `back` in it."""
    q = warp.apply(back, warp.corners(size))
    last = np.array(image.shape[1::-1]) - 1
    left, top = np.clip(q.min(axis=0) - 2, 0, last).astype(int)
    right, low = np.clip(q.max(axis=0) + 3, 0, last).astype(int)
    return image[top : low + 1, left : right + 1], warp.as_homographies([[-top, -left]])[0] @ back


def _light_table(g: ArrayLike | None, n: int, colours: int) -> F64:
    """Return the light of each level (n, C), strictly rising, so that each level can be read back."""
    light = decode_srgb(np.arange(n) / (n - 1)) if g is None else np.exp(as_table(g, n))
    table = np.maximum.accumulate(light.reshape(n, -1), axis=0)
    table = table + np.arange(n)[:, None] * 1e-9 * table[-1]
    if colours < table.shape[1]:  # gray photographs with a response in color: use the green one
        table = table[:, 1:2]
    return np.broadcast_to(table, (n, colours))


def _whole_offset(H: F64) -> list[int] | None:
    """Return (dy, dx) where H shifts by whole pixels, or None."""
    offset = np.rint(H[1::-1, 2]).astype(int)
    shifts = np.allclose(H, warp.as_homographies([offset])[0], rtol=0, atol=1e-9)
    return offset.tolist() if shifts else None


def cut(image: Array, offset: Sequence[int], shown: tuple[slice, slice]) -> Array:
    """Return the rectangle `shown` of an image moved by an offset (dy, dx) of whole pixels."""
    rows, columns = shown
    dy, dx = offset
    return image[rows.start - dy : rows.stop - dy, columns.start - dx : columns.stop - dx]


def _inverse(H: F64, shown: tuple[slice, slice]) -> tuple[F64, tuple[int, int]]:
    """Return the homography from the rectangle `shown` back to an image that H moves, and its size."""
    rows, columns = shown
    first = warp.as_homographies([[rows.start, columns.start]])[0]
    size = (rows.stop - rows.start, columns.stop - columns.start)
    return np.linalg.inv(H) @ first, size


def _touched(mask: Mask, back: F64, size: tuple[int, ...]) -> Mask:
    """Return where one of the 4 x 4 pixels of a cubic mean is in the mask (H, W[, C])."""
    # the 4 x 4 pixels reach from one before to two after
    wide = scipy.ndimage.maximum_filter(mask.view(np.uint8), size=4, axes=(0, 1), origin=-1)
    return warp.before(wide.view(bool), back, size)


def _move_mask(mask: Mask, H: F64, shown: tuple[slice, slice]) -> Mask:
    """Return the rectangle `shown` of a mask moved by H; False where a mean contains a False."""
    offset = _whole_offset(H)
    if offset is not None:
        return cut(mask, offset, shown)
    back, size = _inverse(H, shown)
    return ~_touched(~mask, back, size)
