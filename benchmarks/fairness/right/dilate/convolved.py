"""The mask convolved with a disc, and the outside grown from the frame."""

import numpy as np
from scipy.ndimage import binary_propagation
from scipy.signal import convolve2d


def dilate(mask, margin):
    step = np.arange(-margin, margin + 1)
    disc = (step[:, None] ** 2 + step**2 <= margin**2).astype(int)
    wide = convolve2d(mask.astype(int), disc, mode="same") > 0
    frame = np.ones(np.add(mask.shape, 2), bool)
    frame[1:-1, 1:-1] = False
    free = np.pad(~wide, 1, constant_values=True)
    return ~binary_propagation(frame, mask=free)[1:-1, 1:-1]
