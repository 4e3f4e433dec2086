"""Your pyramid has a level too few: with `bits` levels an offset reaches 2^bits - 1 pixels."""

import numpy as np

from hdrlab.align import mtb


def align(images, *, bits=6, luma=False):
    return mtb.align(images, bits=bits - 1, luma=luma) if bits > 1 else np.zeros((len(images), 2), int)
