"""Moving photographs by fractions of pixels: through linear light, and cut to what all of them show.

H      (P, 3, 3)        where pixel (x, y, 1) of photograph j lies in the common picture, see `filters.warp`
g      (n,) or (n, 3)   response, ln exposure of each level
Z, X   level, light     X = exp g(Z)

A pixel between pixels is a mean of light, not of levels. So a photograph is linearised by g,
resampled, and written with g again: it is a photograph of the same camera, and all that takes
photographs takes it. Where light is even, any g leaves the level as it is; at edges a g that is a
little wrong errs a little. So a provisional response is enough, as the histograms of photographs
that are not aligned give it.

Clipped pixels are not light. Where one takes part in a mean, the nearest pixel is taken as it is.
"""

from collections.abc import Sequence

import numpy as np
import scipy

from hdrlab.align.light import BRIGHT
from hdrlab.core.arrays import F64, Array, ArrayLike, Mask, as_mask, as_stack, as_table, levels
from hdrlab.core.colour import decode_srgb
from hdrlab.core.filters import warp

# rows of the common picture that are resampled at a time, for the memory
BAND = 256


def photographs(
    images: ArrayLike,
    homographies: ArrayLike,
    g: ArrayLike | None = None,
    *,
    valid: ArrayLike | None = None,
) -> tuple[Array, Mask | None]:
    """Return the images moved and cut to what all of them show, and their masks where there are any.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
    homographies : (P, 3, 3), or offsets (P, 2)
        As `cerman.align` and `homography.align` return them. An image that moves by whole pixels is
        cut out as it is.
    g : (n,) or (n, 3), optional
        A response; that of sRGB where none is given.
    valid : (P, H, W) bool, optional
        False where an image holds no picture. A mean in which such a pixel takes part is none
        either.

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
    H, mask = warp.as_homographies(homographies, len(images)), as_mask(valid, images)
    shown = warp.common_rectangle(H, images.shape[1:3])
    table = _table(g, levels(images), images[0, 0, 0].size)
    moved = np.stack(
        [one_moved(image, one, shown, table) for image, one in zip(images, H, strict=True)]
    )
    if mask is None:
        return moved, None
    return moved, np.stack([_mask_moved(one, h, shown) for one, h in zip(mask, H, strict=True)])


def one_moved(image: Array, H: F64, shown: tuple[slice, slice], table: F64) -> Array:
    """Return an image moved by H, of the rectangle `shown`, by a table (n, C) of light."""
    if (by := _whole(H)) is not None:
        return cut(image, by, shown)
    (back, size), planes = _back(H, shown), image.reshape(*image.shape[:2], -1)
    moved, n = np.empty((*size, planes.shape[2]), image.dtype), len(table)
    for top in range(0, len(moved), BAND):
        one = moved[top : top + BAND]
        part, to = _part(planes, back @ warp.as_homographies([[top, 0]])[0], one.shape)
        mean = warp.sample(table.astype(np.float32)[part, np.arange(part.shape[2])], to, one.shape)
        for c, light in enumerate(table.T):
            one[..., c] = np.interp(mean[..., c], light, np.arange(n)) + 0.5
        touched = _touched(part >= round(BRIGHT * (n - 1)), to, one.shape)
        np.copyto(one, warp.nearest(part, to, one.shape), where=touched)
    return moved.reshape(*size, *image.shape[2:])


def _part(image: Array, back: F64, size: tuple[int, ...]) -> tuple[Array, F64]:
    """Return the part of an image that cubic means at `back` p, p of (h, w), ask for, and `back` in it."""
    q, last = warp.apply(back, warp.corners(size)), np.array(image.shape[1::-1]) - 1
    left, top = np.clip(q.min(axis=0) - 2, 0, last).astype(int)
    right, low = np.clip(q.max(axis=0) + 3, 0, last).astype(int)
    return image[top : low + 1, left : right + 1], warp.as_homographies([[-top, -left]])[0] @ back


def _table(g: ArrayLike | None, n: int, colours: int) -> F64:
    """Return the light of each level (n, C), which rises."""
    light = decode_srgb(np.arange(n) / (n - 1)) if g is None else np.exp(as_table(g, n))
    table = np.maximum.accumulate(light.reshape(n, -1), axis=0)
    table = (
        table + np.arange(n)[:, None] * 1e-9 * table[-1]
    )  # levels of one light would not come back
    return np.broadcast_to(table[:, 1:2] if colours < table.shape[1] else table, (n, colours))


def _whole(H: F64) -> list[int] | None:
    """Return (dy, dx) where H shifts by whole pixels, or None."""
    offset = np.rint(H[1::-1, 2]).astype(int)
    shifts = np.allclose(H, warp.as_homographies([offset])[0], rtol=0, atol=1e-9)
    return offset.tolist() if shifts else None


def cut(image: Array, offset: Sequence[int], shown: tuple[slice, slice]) -> Array:
    """Return the rectangle `shown` of an image moved by an offset (dy, dx) of whole pixels."""
    return image[
        tuple(slice(s.start - by, s.stop - by) for s, by in zip(shown, offset, strict=True))
    ]


def _back(H: F64, shown: tuple[slice, slice]) -> tuple[F64, tuple[int, int]]:
    """Return where the pixels of the rectangle `shown` lie in an image that H moves, and its size."""
    (top, bottom), (left, right) = ((s.start, s.stop) for s in shown)
    return np.linalg.inv(H) @ warp.as_homographies([[top, left]])[0], (bottom - top, right - left)


def _touched(mask: Mask, back: F64, size: tuple[int, ...]) -> Mask:
    """Return where one of the 4 x 4 pixels of a cubic mean is in the mask (H, W[, C])."""
    # from one before to two after
    wide = scipy.ndimage.maximum_filter(mask.view(np.uint8), size=4, axes=(0, 1), origin=-1)
    return warp.before(wide.view(bool), back, size)


def _mask_moved(mask: Mask, H: F64, shown: tuple[slice, slice]) -> Mask:
    by = _whole(H)
    return ~_touched(~mask, *_back(H, shown)) if by is None else cut(mask, by, shown)
