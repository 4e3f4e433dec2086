"""Lays all images and one that stays on a big canvas, counts the cover, and cuts where all are."""

import numpy as np


def shift(images, offsets):
    d = np.array(offsets)
    if d.dtype.kind == "f" and np.isfinite(d).all() and (d % 1 == 0).all():
        d = d.astype(np.int64)
    if d.dtype.kind not in "iu" or d.ndim != 2 or d.shape != (len(images), 2):
        raise ValueError("offsets must hold one pair of integers for each image")
    images = np.asarray(images)
    d = d.astype(np.int64)
    if np.count_nonzero(d) == 0:
        return images
    size = np.array(images.shape[1:3])
    if (np.abs(d) >= size).any():
        raise ValueError("an image leaves the frame")
    reach = np.abs(d).max(axis=0)
    canvas = np.zeros((len(images), *(size + 2 * reach), *images.shape[3:]), dtype=images.dtype)
    cover = np.zeros(canvas.shape[1:3], dtype=int)
    cover[reach[0] : reach[0] + size[0], reach[1] : reach[1] + size[1]] += 1
    for p, (dy, dx) in enumerate(d + reach):
        place = np.s_[dy : dy + size[0], dx : dx + size[1]]
        canvas[p][place] = images[p]
        cover[place] += 1
    everywhere = cover == len(images) + 1
    rows, columns = np.flatnonzero(everywhere.any(axis=1)), np.flatnonzero(everywhere.any(axis=0))
    if rows.size == 0:
        raise ValueError("the images have no pixel in common")
    return canvas[:, rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
