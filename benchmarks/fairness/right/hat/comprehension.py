"""A list comprehension over the levels in plain integers, then one division by the middle level's."""

import numpy as np


def hat(n=256):
    weights = [z if 2 * z < n else n - 1 - z for z in range(n)]
    top = weights[(n - 1) // 2]
    return np.array([weight / top if top else 0.0 for weight in weights])
