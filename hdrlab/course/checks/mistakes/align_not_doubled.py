"""A pixel of a level is two of the next finer one: double the offset before you look around it."""

from hdrlab.align import mtb, pairs

TASK = "align"


def align(images, *, bits=6, luma=False):
    return pairs.along([found(*pair) for pair in mtb.neighbours(images, bits, luma)])


def found(fixed, moving):
    offset = (0, 0)
    for level in reversed(range(len(fixed.Y))):
        A, B = (mtb.cut(one.Y[level], int(mtb.threshold(one.h[level], 0.5))) for one in (fixed, moving))
        _, offset = mtb.step(A, B, offset)
    return pairs.Verdict(moving.image, fixed.image, offset, 0, 0, 1, True, "")
