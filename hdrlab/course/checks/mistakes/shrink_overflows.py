"""The sum of four bytes does not fit into a byte, and wraps around: bright places turn dark. Use a wider
type."""

import numpy as np


def shrink(Y):
    rows, columns = Y.shape[0] // 2 * 2, Y.shape[1] // 2 * 2
    Y = Y[:rows, :columns]
    return (Y[::2, ::2] + Y[1::2, ::2] + Y[::2, 1::2] + Y[1::2, 1::2] + np.uint8(2)) >> np.uint8(2)
