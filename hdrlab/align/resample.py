"""Moving photographs by fractions of pixels: through linear light, and cut to what all of them show.

H      (P, 3, 3)        where pixel (x, y, 1) of photograph j lies in the common picture, see `filters.warp`
g      (n,) or (n, 3)   response, ln exposure of each level
Z, X   level, light     X = exp g(Z)

A pixel between pixels is a mean of light, not of levels. So a photograph is linearised by g, resampled, and
written with g again: it is a photograph of the same camera, and all that takes photographs takes it. Where
light is even, any g leaves the level as it is; at edges a g that is a little wrong errs a little. So a
provisional response is enough, as the histograms of photographs that are not aligned give it.

Clipped pixels are not light. Where one takes part in a mean, the nearest pixel is taken as it is.
"""

import numpy as np
import scipy

from hdrlab.align.light import BRIGHT
from hdrlab.core.arrays import as_mask, as_stack, as_table, levels
from hdrlab.core.colour import decode_srgb
from hdrlab.core.filters import warp
from hdrlab.core.types import F64, Array, ArrayLike, Mask


def photographs(
    images: ArrayLike, homographies: ArrayLike, g: ArrayLike | None = None, *, valid: ArrayLike | None = None
) -> tuple[Array, Mask | None]:
    """Return the images moved and cut to what all of them show, and their masks where there are any.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
    homographies : (P, 3, 3), or offsets (P, 2)
        As `cerman.align` and `homography.align` return them. An image that moves by whole pixels is cut out
        as it is.
    g : (n,) or (n, 3), optional
        A response; that of sRGB where none is given.
    valid : (P, H, W) bool, optional
        False where an image holds no picture. A mean in which such a pixel takes part is none either.

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
    table = _table(g, levels(images), images.ndim - 2)
    moved = np.stack([one_moved(image, one, shown, table) for image, one in zip(images, H, strict=True)])
    if mask is None:
        return moved, None
    return moved, np.stack([_mask_moved(one, h, shown) for one, h in zip(mask, H, strict=True)])


def one_moved(image: Array, H: F64, shown: tuple[slice, slice], table: F64) -> Array:
    """Return an image moved by H, of the rectangle `shown`, by a table (n, C) of light."""
    if (whole := _whole(H)) is not None:
        return image[tuple(slice(s.start - d, s.stop - d) for s, d in zip(shown, whole, strict=True))]
    back, size = _back(H, shown), (shown[0].stop - shown[0].start, shown[1].stop - shown[1].start)
    planes = image[..., None] if image.ndim == 2 else image
    clipped = planes >= round(BRIGHT * (len(table) - 1))
    moved = np.empty((*size, planes.shape[2]), image.dtype)
    for c in range(planes.shape[2]):
        Z = planes[..., c]
        light = warp.sample(table[:, c].astype(np.float32)[Z], back, size)
        mean = np.interp(light, table[:, c], np.arange(len(table)))
        near = warp.nearest(Z.astype(np.float32), back, size)
        moved[..., c] = np.where(_touched(clipped[..., c], back, size), near, mean) + 0.5
    return moved.reshape(*size, *image.shape[2:])


def _table(g: ArrayLike | None, n: int, colours: int) -> F64:
    """Return the light of each level (n, C), which rises."""
    light = decode_srgb(np.arange(n) / (n - 1)) if g is None else np.exp(as_table(g, n))
    table = np.maximum.accumulate(light.reshape(n, -1), axis=0)
    table = table + np.arange(n)[:, None] * 1e-9 * table[-1]  # levels of one light would not come back
    return np.asarray(
        table[:, [1]] if colours == 1 and table.shape[1] == 3 else table.repeat(4 - table.shape[1], 1)
    )


def _whole(H: F64) -> tuple[int, int] | None:
    """Return (dy, dx) where H shifts by whole pixels, or None."""
    dx, dy = np.round(H[:2, 2])
    shift = warp.as_homographies([[dy, dx]])[0]
    return (int(dy), int(dx)) if np.allclose(H, shift, rtol=0, atol=1e-9) else None


def _back(H: F64, shown: tuple[slice, slice]) -> F64:
    """Return where the pixels of the rectangle `shown` lie in an image that H moves."""
    return np.asarray(np.linalg.inv(H) @ warp.as_homographies([[shown[0].start, shown[1].start]])[0])


def _touched(mask: Mask, back: F64, size: tuple[int, int]) -> Mask:
    """Return where one of the 4 x 4 pixels of a cubic mean is in the mask."""
    # from one before to two after
    wide = scipy.ndimage.maximum_filter(mask.view(np.uint8), size=4, origin=-1)
    return warp.before(wide.astype(np.float32), back, size) > 0.5


def _mask_moved(mask: Mask, H: F64, shown: tuple[slice, slice]) -> Mask:
    if (whole := _whole(H)) is not None:
        return mask[tuple(slice(s.start - d, s.stop - d) for s, d in zip(shown, whole, strict=True))]
    size = (shown[0].stop - shown[0].start, shown[1].stop - shown[1].start)
    return ~_touched(~mask, _back(H, shown), size)
