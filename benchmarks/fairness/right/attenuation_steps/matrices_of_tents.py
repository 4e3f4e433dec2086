"""Blur and enlargement as small matrices from the left and right (tents at 0, 2, 4 ...); returns a list."""

import numpy as np


def blur_and_halve(n):
    """Rows of weights 1 4 6 4 1 around every second pixel, mirrored at both ends."""
    m = np.zeros(((n + 1) // 2, n))
    for i in range(len(m)):
        for step, weight in zip((-2, -1, 0, 1, 2), (1, 4, 6, 4, 1)):
            j = abs(2 * i + step)
            m[i, j if j < n else 2 * (n - 1) - j] += weight / 16
    return m


def tents(n):
    small = np.arange((n + 1) // 2)
    at = np.minimum(np.arange(n) / 2, small[-1])
    return np.maximum(0, 1 - np.abs(at[:, None] - small[None, :]))


def central(n):
    m = np.zeros((n, n))
    for i in range(n):
        m[i, i + 1 if i + 1 < n else n - 2] += 0.5
        m[i, i - 1 if i > 0 else 1] -= 0.5
    return m


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    pictures = [np.array(lL, dtype=np.float64)]
    while (min(pictures[-1].shape) + 1) // 2 >= 32:
        H, W = pictures[-1].shape
        pictures.append(blur_and_halve(H) @ pictures[-1] @ blur_and_halve(W).T)
    steps = []
    for k in range(len(pictures) - 1, -1, -1):
        l = pictures[k]
        H, W = l.shape
        slope = np.sqrt((central(H) @ l) ** 2 + (l @ central(W).T) ** 2) / 2**k
        mean = slope.sum() / slope.size
        if mean == 0:
            phi = np.ones((H, W))
        else:
            phi = (np.where(slope < noise * mean, noise * mean, slope) / alpha / mean) ** (beta - 1)
        Phi = tents(H) @ steps[-1][4] @ tents(W).T * phi if steps else phi
        steps.append((k, l, slope, phi, Phi))
    return steps
