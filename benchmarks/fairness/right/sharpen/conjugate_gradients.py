"""Conjugate gradients with convolutions; no matrix at all."""

import numpy as np


def one(y, h):
    h = h / len(h)
    x = np.zeros(len(y) - len(h) + 1)
    r = np.correlate(y, h, "valid")
    p, rr = r.copy(), r @ r
    for _ in range(400):
        if rr < 1e-26:
            break
        Np = np.correlate(np.convolve(p, h), h, "valid")
        step = rr / (p @ Np)
        x, r = x + step * p, r - step * Np
        new = r @ r
        p, rr = r + new / rr * p, new
    return x


def sharpen(y, h):
    return one(y, h) if y.ndim == 1 else np.array([one(column, h) for column in y.T]).T
