"""Your offsets say where the images have moved to; asked is where they must move to lie on the one in the
middle: change the sign."""

from hdrlab.align import mtb


def align(images, *, bits=6, luma=False):
    return -mtb.align(images, bits=bits, luma=luma)
