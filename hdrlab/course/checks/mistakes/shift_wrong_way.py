"""Your images move the wrong way: (dy, dx) is where an image must go, down and to the right."""

from hdrlab.align import shift as moving


def shift(images, offsets):
    return moving.shift(images, -offsets)
