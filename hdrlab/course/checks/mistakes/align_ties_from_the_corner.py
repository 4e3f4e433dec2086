"""Where all nine candidates are equally good you take the first, in the corner, and walk off a pixel a
level: begin with the centre."""

import numpy as np

from hdrlab.align import mtb, pairs
from hdrlab.align.bitmaps import around, error

TASK = "align"


def align(images, *, bits=6, luma=False):
    return pairs.along([found(*pair) for pair in mtb.neighbours(images, bits, luma)])


def found(fixed, moving):
    offset = np.zeros(2, int)
    for level in reversed(range(len(fixed.Y))):
        A, B = (mtb.cut(one.Y[level], int(mtb.threshold(one.h[level], 0.5))) for one in (fixed, moving))
        best = np.argmin(error(around(A, B, tuple(2 * offset))))
        offset = 2 * offset + np.divmod(best, 3) - 1
    return pairs.Verdict(moving.image, fixed.image, tuple(offset), 0, 0, 1, True, "")
