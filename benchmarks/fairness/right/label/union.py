"""Union-find over pairs of neighbours, in row order."""

import numpy as np


def label(mask):
    mask = np.asarray(mask, bool)
    parent = {}

    def root(k):
        while parent[k] != k:
            parent[k] = parent[parent[k]]
            k = parent[k]
        return k

    for y, x in np.argwhere(mask).tolist():
        parent[y, x] = (y, x)
        for k in ((y - 1, x - 1), (y - 1, x), (y - 1, x + 1), (y, x - 1)):
            if k in parent:
                parent[root(k)] = root((y, x))
    names, out = {}, np.zeros(mask.shape, np.int32)
    for k in parent:
        out[k] = names.setdefault(root(k), len(names) + 1)
    return out
