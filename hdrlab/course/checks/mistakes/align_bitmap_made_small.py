"""You make the bitmap of the whole picture small, instead of the picture: at the coarse levels fine texture
is noise then."""

from itertools import pairwise

from hdrlab.align import mtb


def align(images, *, bits=6, luma=False):
    order = mtb.by_brightness(images)
    Y = [mtb.gray(images[image], luma=luma) for image in order]
    return mtb.chain_offsets(order, [offset_of(fixed, moving, bits) for moving, fixed in pairwise(Y)])


def offset_of(fixed, moving, bits):
    A, B = mtb.bitmaps(fixed), mtb.bitmaps(moving)
    y, x = 0, 0
    for level in reversed(range(len(list(mtb.search(fixed, moving, bits=bits))))):
        errors = mtb.step(A[:, :: 2**level, :: 2**level], B[:, :: 2**level, :: 2**level], (2 * y, 2 * x))
        y, x = min(errors, key=errors.get)
    return y, x
