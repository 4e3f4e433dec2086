"""np.roll moves each image, what came round the border is cut off; whole floats pass for integers."""

import numpy as np


def _pairs(offsets, P):
    try:
        given = np.asarray(offsets, dtype=float)
    except (TypeError, ValueError):
        raise ValueError("offsets are not numbers") from None
    if given.shape != (P, 2):
        raise ValueError(f"offsets must be ({P}, 2), not {given.shape}")
    if not (given == np.round(given)).all() or not np.isfinite(given).all():
        raise ValueError("offsets must be whole pixels")
    return given.astype(int)


def shift(images, offsets):
    pairs = _pairs(offsets, len(images))
    if (pairs == 0).all():
        return images
    H, W = images.shape[1], images.shape[2]
    y0, x0 = max(0, pairs[:, 0].max()), max(0, pairs[:, 1].max())
    y1, x1 = H + min(0, pairs[:, 0].min()), W + min(0, pairs[:, 1].min())
    if y0 >= y1 or x0 >= x1:
        raise ValueError("no pixel is covered by all images")
    moved = np.empty_like(images)
    for p in range(len(images)):
        moved[p] = np.roll(images[p], tuple(pairs[p]), axis=(0, 1))
    return moved[:, y0:y1, x0:x1]
