"""Where all nine candidates are equally good you take the first, in the corner, and walk off a pixel a
level: begin with the centre."""

from itertools import pairwise

from hdrlab.align import mtb


def align(images, *, bits=6, luma=False):
    order = mtb.by_brightness(images)
    Y = [mtb.gray(images[image], luma=luma) for image in order]
    return mtb.chain_offsets(order, [offset_of(fixed, moving, bits) for moving, fixed in pairwise(Y)])


def offset_of(fixed, moving, bits):
    y, x = 0, 0
    for state in mtb.search(fixed, moving, bits=bits):
        errors = mtb.step(state.fixed, state.moving, (2 * y, 2 * x))
        y, x = min(sorted(errors), key=errors.get)
    return y, x
