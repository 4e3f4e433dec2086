"""numpy's convolution of each column."""

import numpy as np


def smear(x, h):
    columns = x.reshape(len(x), -1).T
    y = np.stack([np.convolve(column, h) for column in columns], axis=-1) / len(h)
    return y.reshape(-1, *x.shape[1:])
