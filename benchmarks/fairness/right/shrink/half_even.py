"""numpy's rounding to even; floats."""

import numpy as np


def shrink(Y):
    Y = Y.astype(np.float32)[: Y.shape[0] // 2 * 2, : Y.shape[1] // 2 * 2]
    return np.round((Y[::2, ::2] + Y[1::2, ::2] + Y[::2, 1::2] + Y[1::2, 1::2]) / 4)
