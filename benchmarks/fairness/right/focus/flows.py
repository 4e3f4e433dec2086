"""The difference of flows across the borders of pixels; none across the border of the block."""

import numpy as np


def focus(block, *, noise=20.0):
    down = np.diff(block, axis=0)
    right = np.diff(block, axis=1)
    x = np.zeros(block.shape)
    x[:-1] += down
    x[1:] -= down
    x[:, :-1] += right
    x[:, 1:] -= right
    x = np.abs(x)
    return np.where(x > noise, x, 0.0).mean()
