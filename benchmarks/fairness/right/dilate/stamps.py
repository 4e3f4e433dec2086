"""A disc stamped row by row of shifts, then a flood from a frame one pixel outside, by a stack."""

import numpy as np


def dilate(mask, margin):
    mask = np.asarray(mask, bool)
    H, W = mask.shape
    m = int(margin)
    wide = np.zeros((H + 2 * m, W + 2 * m), bool)
    for dy in range(2 * m + 1):
        for dx in range(2 * m + 1):
            if (dy - m) ** 2 + (dx - m) ** 2 <= m * m:
                wide[dy : dy + H, dx : dx + W] |= mask
    free = np.pad(~wide[m : m + H, m : m + W], 1, constant_values=True)
    stack = [(0, 0)]
    free[0, 0] = False
    while stack:
        y, x = stack.pop()
        for v, u in ((y - 1, x), (y + 1, x), (y, x - 1), (y, x + 1)):
            if 0 <= v < H + 2 and 0 <= u < W + 2 and free[v, u]:
                free[v, u] = False
                stack.append((v, u))
    return wide[m : m + H, m : m + W] | free[1:-1, 1:-1]
