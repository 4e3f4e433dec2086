"""One fancy index with three broadcast index arrays; zero offsets give a view of the images."""

import operator

import numpy as np


def shift(images, offsets):
    images = np.asarray(images)
    P, H, W = images.shape[:3]
    try:
        rows = [[operator.index(v) for v in pair] for pair in offsets]
    except TypeError as error:
        raise ValueError("offsets must be pairs of integers") from error
    if len(rows) != P or any(len(row) != 2 for row in rows):
        raise ValueError("one pair (dy, dx) per image is needed")
    dys, dxs = [r[0] for r in rows], [r[1] for r in rows]
    y = np.arange(max([0] + dys), H + min([0] + dys))
    x = np.arange(max([0] + dxs), W + min([0] + dxs))
    if y.size == 0 or x.size == 0:
        raise ValueError("these offsets leave nothing in common")
    if not any(dys) and not any(dxs):
        return images[:]
    source_y = y[None, :, None] - np.array(dys)[:, None, None]
    source_x = x[None, None, :] - np.array(dxs)[:, None, None]
    return images[np.arange(P)[:, None, None], source_y, source_x]
