"""A grid of 9 x 9 scales around the best so far, closer each time."""

import numpy as np


def fit_channel_scales(I, M):
    t = M / np.sqrt(np.sum(M**2, axis=1, keepdims=True))
    best, width = np.zeros(2), np.log(10)
    for _ in range(40):
        steps = np.linspace(-width, width, 9)
        lowest = np.inf
        for r in steps:
            for b in steps:
                a = I * np.exp([best[0] + r, 0, best[1] + b])
                a /= np.sqrt(np.sum(a**2, axis=1, keepdims=True))
                cost = np.sum((a - t) ** 2)
                if cost < lowest:
                    lowest, found = cost, best + [r, b]
        best, width = found, width * 0.7
    return np.exp([best[0], 0, best[1]])
