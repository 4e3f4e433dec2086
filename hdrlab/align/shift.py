"""Moving the photographs where the alignment says, and cutting them to what all of them show.

offsets  (P, 2) int, pixels  (dy, dx): image j goes dy pixels down and dx to the right
crop     two slices          the rectangle, in the coordinates of an image that stays, that every image covers
"""

import numpy as np

from hdrlab.core.arrays import Array, ArrayLike, NDArray
from hdrlab.errors import InputError


def as_offsets(offsets: ArrayLike, count: int | None = None) -> NDArray[np.int64]:
    """Return `offsets` as int64 (P, 2), one for each image, or raise a ValueError that says what came."""
    array = np.asarray(offsets)
    if (
        array.shape[1:] != (2,)
        or len(array) != (count or len(array))
        or array.dtype.kind not in "iu"
    ):
        wanted = f"expected offsets ({count or 'P'}, 2) of whole pixels, one per image"
        raise InputError(f"{wanted}, got {array.dtype} {array.shape}")
    return array.astype(np.int64)


def crop(offsets: ArrayLike, shape: tuple[int, ...]) -> tuple[slice, slice]:
    """Return the rectangle (rows, columns) that every moved image covers; `shape` begins with (H, W).

    Raises
    ------
    ValueError
        Where the offsets leave no pixel that all images cover.
    """
    moved = as_offsets(offsets)
    first = np.maximum(moved.max(axis=0), 0)
    end = np.minimum(moved.min(axis=0), 0) + shape[:2]
    if np.any(first >= end):
        raise InputError(
            f"expected images that overlap, got offsets {moved.tolist()} for {shape[:2]} pixels"
        )
    return slice(int(first[0]), int(end[0])), slice(int(first[1]), int(end[1]))


def shift(images: ArrayLike, offsets: ArrayLike) -> Array:
    """Return the images moved by `offsets` and cut to `crop`, so that every pixel is a photograph's own.

    Parameters
    ----------
    images : (P, H, W) or (P, H, W, 3), uint8 or uint16
    offsets : (P, 2) int, pixels
        (dy, dx), down and right: where each image must move.

    Returns
    -------
    moved : (P, h, w) or (P, h, w, 3), of the images' dtype
        The images themselves, not a copy, where every offset is 0.

    Raises
    ------
    ValueError
        For offsets that are not one pair of integers per image, or that leave nothing in common.

    Examples
    --------
    >>> import numpy as np
    >>> from hdrlab.align.shift import shift
    >>> images = np.arange(2 * 3 * 4, dtype=np.uint8).reshape(2, 3, 4)
    >>> shift(images, [[0, 0], [1, -1]]).tolist()
    [[[4, 5, 6], [8, 9, 10]], [[13, 14, 15], [17, 18, 19]]]
    """
    images = np.asarray(images)
    if images.ndim < 3:
        raise InputError(f"expected images (P, H, W[, 3]), got {images.dtype} {images.shape}")
    moved = as_offsets(offsets, len(images))
    if not moved.any():
        return images
    rows, columns = crop(moved, images.shape[1:3])
    return np.stack(
        [
            image[rows.start - dy : rows.stop - dy, columns.start - dx : columns.stop - dx]
            for image, (dy, dx) in zip(images, moved.tolist(), strict=True)
        ]
    )
