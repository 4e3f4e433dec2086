"""Dilation by a disc, and holes by labels of what is outside."""

import numpy as np
from scipy.ndimage import binary_dilation, label


def dilate(mask, margin):
    y, x = np.mgrid[-margin : margin + 1, -margin : margin + 1]
    wide = binary_dilation(mask, y**2 + x**2 <= margin**2)
    outside, _ = label(np.pad(~wide, 1, constant_values=True))
    return (outside != outside[0, 0])[1:-1, 1:-1]
