"""On a canvas with NaN, and cut where all are there."""

import numpy as np


def shift(images, offsets):
    images = np.asarray(images)
    P, H, W = images.shape[:3]
    canvas = np.full(images.shape, np.nan)
    for j, (dy, dx) in enumerate(np.asarray(offsets).tolist()):
        ys, xs = range(max(dy, 0), min(H + dy, H)), range(max(dx, 0), min(W + dx, W))
        canvas[j, ys[0] : ys[-1] + 1, xs[0] : xs[-1] + 1] = images[
            j, ys[0] - dy : ys[-1] + 1 - dy, xs[0] - dx : xs[-1] + 1 - dx
        ]
    there = np.isfinite(canvas).reshape(P, H, W, -1).all(axis=(0, 3))
    rows, columns = np.flatnonzero(there.any(axis=1)), np.flatnonzero(there.any(axis=0))
    return canvas[:, rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1].astype(images.dtype)
