"""Rolled, and cut; a list of images."""

import numpy as np


def shift(images, offsets):
    offsets = np.asarray(offsets)
    H, W = np.shape(images)[1:3]
    top, left = (max(0, int(offsets[:, k].max())) for k in (0, 1))
    bottom, right = (n + min(0, int(offsets[:, k].min())) for k, n in ((0, H), (1, W)))
    return [
        np.roll(image, tuple(int(one) for one in offset), axis=(0, 1))[top:bottom, left:right]
        for image, offset in zip(images, offsets, strict=True)
    ]
