"""Halves the interval of sigma."""

import numpy as np


def spot(shape, at, share):
    y, x = np.indices(shape) + 0.5
    d = np.hypot(y - at[0] * shape[0], x - at[1] * shape[1])
    n = max(round(share * d.size), 1)
    return d <= np.sort(d.ravel())[n - 1]


def centre(shape, *, inside=0.7, share=0.25, at=(0.5, 0.5)):
    disc = spot(shape, at, share)
    y, x = np.indices(shape) + 0.5
    d2 = (y / shape[0] - at[0]) ** 2 + (x / shape[1] - at[1]) ** 2
    low, high = 1e-3, 1e3
    for _ in range(100):
        sigma = (low + high) / 2
        w = np.exp(-d2 / (2 * sigma**2))
        w /= w.sum()
        if w[disc].sum() > inside:
            low = sigma
        else:
            high = sigma
    return w
