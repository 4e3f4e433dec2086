"""Flood by a stack, regions in order of columns."""

import numpy as np


def label(mask):
    mask = np.asarray(mask, bool)
    H, W = mask.shape
    out = np.zeros((H, W), int)
    count = 0
    for x0, y0 in np.argwhere(mask.T):
        if out[y0, x0]:
            continue
        count += 1
        out[y0, x0] = count
        stack = [(y0, x0)]
        while stack:
            y, x = stack.pop()
            for v in range(max(y - 1, 0), min(y + 2, H)):
                for u in range(max(x - 1, 0), min(x + 2, W)):
                    if mask[v, u] and not out[v, u]:
                        out[v, u] = count
                        stack.append((v, u))
    return out
