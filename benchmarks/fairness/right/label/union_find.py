"""Two passes with a table of which labels are one."""

import numpy as np


def label(mask):
    H, W = mask.shape
    parent = [0]

    def root(k):
        while parent[k] != k:
            k = parent[k]
        return k

    first = np.zeros((H, W), int)
    for y in range(H):
        for x in range(W):
            if not mask[y, x]:
                continue
            near = [(y, x - 1), (y - 1, x - 1), (y - 1, x), (y - 1, x + 1)]
            found = [root(first[p]) for p in near if p[0] >= 0 and 0 <= p[1] < W and first[p]]
            if not found:
                parent.append(len(parent))
                found = [len(parent) - 1]
            first[y, x] = min(found)
            for one in found:
                parent[one] = min(found)
    names = {0: 0}
    return [[names.setdefault(root(k), len(names)) for k in row] for row in first.tolist()]
