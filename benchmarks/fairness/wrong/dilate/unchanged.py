"""The mask itself."""


def dilate(mask, margin):
    return mask
