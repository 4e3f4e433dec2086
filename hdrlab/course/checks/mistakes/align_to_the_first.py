"""A wrong align: to the first."""

from hdrlab.align import mtb

TASK = "align"
MISCONCEPTION = (
    "Your offsets lay the images on the first one; the one in the middle of their brightness is to stay."
)


def align(images, *, bits=6, luma=False):
    offsets = mtb.align(images, bits=bits, luma=luma)
    return offsets - offsets[0]
