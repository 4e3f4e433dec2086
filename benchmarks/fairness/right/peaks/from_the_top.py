"""The values from the largest on, until there are enough peaks; float shifts."""

import numpy as np


def peaks(c, count):
    result = []
    for k in np.argsort(c, axis=None)[::-1]:
        i, j = divmod(int(k), c.shape[1])
        if c[i, j] <= 0 or len(result) == count:
            break
        if c[i, j] == np.max(c[max(0, i - 2) : i + 3, max(0, j - 2) : j + 3]):
            result.append([i - (c.shape[0] - 1) / 2, j - (c.shape[1] - 1) / 2])
    return np.array(result)
