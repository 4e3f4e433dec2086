"""A disc is stamped on each pixel; then a walk from the border finds what is outside."""

import numpy as np


def dilate(mask, margin):
    H, W = mask.shape
    wide = np.zeros((H + 2, W + 2), bool)
    for y, x in zip(*np.nonzero(mask)):
        for dy in range(-margin, margin + 1):
            for dx in range(-margin, margin + 1):
                if dy * dy + dx * dx <= margin * margin and 0 <= y + dy < H and 0 <= x + dx < W:
                    wide[y + dy + 1, x + dx + 1] = True
    outside, waiting = np.zeros_like(wide), [(0, 0)]
    while waiting:
        y, x = waiting.pop()
        if 0 <= y < H + 2 and 0 <= x < W + 2 and not wide[y, x] and not outside[y, x]:
            outside[y, x] = True
            waiting += [(y + 1, x), (y - 1, x), (y, x + 1), (y, x - 1)]
    return ~outside[1:-1, 1:-1]
