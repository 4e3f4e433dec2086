"""Return an array whose elements overlap and whose strides lead before its beginning."""

import numpy as np


def double(x):
    return np.lib.stride_tricks.as_strided(np.zeros(64)[32:], x.shape, (-8, -8))
