"""A pixel of a level is two of the next finer one: double the offset before you look around it."""

from itertools import pairwise

from hdrlab.align import mtb


def align(images, *, bits=6, luma=False):
    order = mtb.by_brightness(images)
    Y = [mtb.gray(images[image], luma=luma) for image in order]
    return mtb.chain_offsets(order, [offset_of(fixed, moving, bits) for moving, fixed in pairwise(Y)])


def offset_of(fixed, moving, bits):
    offset = (0, 0)
    for state in mtb.search(fixed, moving, bits=bits):
        errors = mtb.step(state.fixed, state.moving, offset)
        offset = min(errors, key=errors.get)
    return offset
