"""You took dx for dy: an offset is (dy, dx), rows first, like the axes of the array."""

from hdrlab.align import shift as moving


def shift(images, offsets):
    return moving.shift(images, offsets[:, ::-1])
