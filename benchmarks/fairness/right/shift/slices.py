"""A slice per image; integers by dtype only, so 2.0 is refused; zero offsets give the very array."""

import numpy as np


def shift(images, offsets):
    images = np.asarray(images)
    offsets = np.asarray(offsets)
    if offsets.shape != (len(images), 2) or offsets.dtype.kind not in "iu":
        raise ValueError("offsets must be one pair of integers per image")
    offsets = offsets.astype(np.int64)
    if not offsets.any():
        return images
    height, width = images.shape[1:3]
    top, left = np.maximum(offsets.max(axis=0), 0)
    bottom, right = np.minimum(offsets.min(axis=0), 0) + (height, width)
    if bottom <= top or right <= left:
        raise ValueError("the images have nothing in common")
    return np.stack(
        [
            im[top - dy : bottom - dy, left - dx : right - dx]
            for im, (dy, dx) in zip(images, offsets)
        ]
    )
