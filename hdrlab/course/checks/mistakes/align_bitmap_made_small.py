"""You make the bitmap of the whole picture small, instead of the picture: at the coarse levels fine texture
is noise then."""

import numpy as np

from hdrlab.align import mtb, pairs
from hdrlab.align.bitmaps import pack

TASK = "align"


def align(images, *, bits=6, luma=False):
    return pairs.along([found(*pair) for pair in mtb.neighbours(images, bits, luma)])


def found(fixed, moving):
    masks = []
    for one in (fixed, moving):
        t = int(mtb.threshold(one.h[0], 0.5))
        masks.append(np.stack([mtb.bitmap(one.Y[0], t), mtb.exclusion(one.Y[0], t)]))
    offset = (0, 0)
    for level in reversed(range(len(fixed.Y))):
        A, B = (pack(np.ascontiguousarray(mask[:, :: 2**level, :: 2**level])) for mask in masks)
        _, offset = mtb.step(A, B, (2 * offset[0], 2 * offset[1]))
    return pairs.Verdict(moving.image, fixed.image, offset, 0, 0, 1, True, "")
