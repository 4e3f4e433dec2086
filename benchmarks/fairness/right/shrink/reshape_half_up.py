"""Reshapes into blocks and adds 2 before dividing the sum by 4: a half goes up."""

import numpy as np


def shrink(Y):
    Y = np.asarray(Y)
    h, w = Y.shape[0] // 2, Y.shape[1] // 2
    blocks = Y[: 2 * h, : 2 * w].reshape(h, 2, w, 2)
    return ((blocks.sum(axis=(1, 3), dtype=np.uint32) + 2) // 4).astype(Y.dtype)
