"""Regions of a map: threshold, dilation, connected components; and seams between two maps.

mask    (H, W) bool; labels  (H, W) int32, 1 ... R, 0 elsewhere
alpha   (H, W) float32, 0 outside the regions, 1 inside, a ramp of a few pixels between them
"""

import numpy as np
from scipy import ndimage

from hdrlab.core.arrays import F32, Labels, Mask

Box = tuple[slice, slice]
# pixels; a thinner contradiction is an edge or noise
SEED_SIDE = 3
CONNECTED = np.ones((3, 3), bool)


def find_seeds(score: F32) -> Mask:
    """Return where the score exceeds 1 over at least 3 x 3 pixels."""
    return ndimage.binary_opening(score > 1, np.ones((SEED_SIDE, SEED_SIDE), bool))


def grow(seed: Mask, weak: Mask, reach: int) -> Mask:
    """Return the seeds and the weak pixels that connect with them, at most `reach` pixels away."""
    return ndimage.binary_dilation(seed, CONNECTED, iterations=max(reach, 1), mask=weak | seed)


def dilate(mask: Mask, margin: int) -> Mask:
    """Return the mask, all pixels within `margin` of it, and the holes that these enclose."""
    if not mask.any():
        return mask
    return ndimage.binary_fill_holes(ndimage.distance_transform_edt(~mask) <= margin)


def label(mask: Mask) -> Labels:
    """Return the connected components of a mask, labelled 1 ... R; corners connect."""
    return ndimage.label(mask, CONNECTED)[0].astype(np.int32)


def feather(labels: Labels, width: int) -> F32:
    """Return alpha: 0 outside, rising over `width` pixels inside each region to 1.

    Examples
    --------
    >>> feather(np.pad(np.ones((7, 5), np.int32), 2), 2)[5].round(2)
    array([0.  , 0.  , 0.33, 0.67, 1.  , 0.67, 0.33, 0.  , 0.  ],
          dtype=float32)
    """
    depth = ndimage.distance_transform_edt(labels > 0)
    return np.minimum(depth / (width + 1), 1).astype(np.float32)


def blend(E: F32, other: F32, alpha: F32) -> F32:
    """Return E^(1 - alpha) other^alpha: the seam is uniform in stops, as the eye perceives it."""
    a = alpha if E.ndim == 2 else alpha[..., None]
    both = (E > 0) & (other > 0)
    with np.errstate(divide="ignore", invalid="ignore"):
        mixed = np.exp((1 - a) * np.log(E) + a * np.log(other))
    return np.where(a == 0, E, np.where((a == 1) | ~both, other, mixed)).astype(np.float32)


def pad_box(box: Box, by: int, shape: tuple[int, ...]) -> Box:
    """Return a box enlarged by some pixels on each side, within the picture."""
    rows, columns = box
    height, width = shape[:2]
    y = slice(max(rows.start - by, 0), min(rows.stop + by, height))
    x = slice(max(columns.start - by, 0), min(columns.stop + by, width))
    return y, x
