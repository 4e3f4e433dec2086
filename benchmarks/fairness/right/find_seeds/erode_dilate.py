"""Erosion and dilation along the axes, one after the other."""

from scipy.ndimage import binary_dilation, binary_erosion


def find_seeds(score):
    mask = score > 1
    for one in ([[1, 1, 1]], [[1], [1], [1]]):
        mask = binary_erosion(mask, one)
    for one in ([[1, 1, 1]], [[1], [1], [1]]):
        mask = binary_dilation(mask, one)
    return mask.tolist()
