"""Cut out of each image."""

import numpy as np


def shift(images, offsets):
    images, offsets = np.asarray(images), np.asarray(offsets)
    H, W = images.shape[1:3]
    top, left = np.maximum(offsets.max(axis=0), 0)
    bottom, right = np.minimum(offsets.min(axis=0), 0) + (H, W)
    return np.stack(
        [
            im[top - dy : bottom - dy, left - dx : right - dx]
            for im, (dy, dx) in zip(images, offsets, strict=True)
        ]
    )
