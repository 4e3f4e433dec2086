"""The object is added at each open chop."""

import numpy as np


def smear(x, h):
    y = np.zeros((len(x) + len(h) - 1,) + x.shape[1:])
    for k in range(len(h)):
        if h[k] > 0:
            y[k : k + len(x)] += x
    return y / len(h)
