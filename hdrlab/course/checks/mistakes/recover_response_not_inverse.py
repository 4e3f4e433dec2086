"""A wrong recover: response not inverse."""

import numpy as np

from hdrlab.response import mitsunaga

TASK = "recover"
MISCONCEPTION = "You answer f, the exposure of each level; asked is its logarithm, g = ln f."


def recover(images, times, *, order=5, eps=1e-3):
    return np.exp(mitsunaga.recover(images, times, order=order, eps=eps))
