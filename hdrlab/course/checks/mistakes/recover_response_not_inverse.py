"""You answer f^-1, the exposure of each level; asked is its logarithm, g = ln f^-1."""

import numpy as np

from hdrlab.response import mitsunaga


def recover(images, times, *, order=5, eps=1e-3):
    return np.exp(mitsunaga.recover(images, times, order=order, eps=eps))
