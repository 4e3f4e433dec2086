"""scipy.ndimage.shift of order 0 moves each image; a mask moved alike tells where to cut."""

import numpy as np
from scipy import ndimage


def shift(images, offsets):
    offsets = np.asarray(offsets)
    if offsets.ndim != 2 or offsets.shape[1] != 2 or offsets.shape[0] != len(images):
        raise ValueError("offsets must be (P, 2)")
    if not np.issubdtype(offsets.dtype, np.integer):
        raise ValueError("offsets must be integers")
    if np.all(offsets == 0):
        return images
    images = np.asarray(images)
    height, width = images.shape[1:3]
    covered = np.ones((height, width), dtype=bool)
    moved = []
    for image, (dy, dx) in zip(images, offsets.tolist()):
        if abs(dy) >= height or abs(dx) >= width:
            raise ValueError("an image was moved out of the picture")
        step = (dy, dx) + (0,) * (image.ndim - 2)
        moved.append(ndimage.shift(image, step, order=0, mode="constant", cval=0))
        mask = np.ones((height, width), dtype=np.uint8)
        covered &= ndimage.shift(mask, (dy, dx), order=0, mode="constant", cval=0).astype(bool)
    ys, xs = np.nonzero(covered)
    if len(ys) == 0:
        raise ValueError("nothing in common")
    return np.array(moved)[:, ys.min() : ys.max() + 1, xs.min() : xs.max() + 1]
