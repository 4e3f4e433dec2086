"""A wrong shift: wrong way."""

from hdrlab.align import shift as moving

TASK = "shift"
MISCONCEPTION = "Your images move the wrong way: (dy, dx) is where an image must go, down and to the right."


def shift(images, offsets):
    return moving.shift(images, -offsets)
