"""The Gaussian by hand: 4 sigma far, on an image mirrored at its edges."""

import numpy as np


def blur(x, sigma):
    reach = int(4 * sigma + 0.5)
    d = np.arange(-reach, reach + 1)
    k = np.exp(-(d**2) / (2 * sigma**2))
    k /= k.sum()
    h, w = x.shape
    p = np.pad(x, reach, mode="symmetric")
    p = sum(k[i] * p[i : i + h] for i in range(len(k)))
    return sum(k[i] * p[:, i : i + w] for i in range(len(k)))


def reconstruct(Z, e, c=None, *, sigma=0.5, full_well=np.inf, read_noise=0.0):
    X = Z / 255.0
    noise = X / full_well + (read_noise / full_well) ** 2 + 1 / (12 * 255**2)
    w = np.where(X >= 0.995, 0, e**2 / noise)
    planes = [np.ones(Z.shape)] if c is None else [1.0 * (c == k) for k in range(3)]
    E = [blur(m * w * X / e, sigma) / blur(m * w, sigma) for m in planes]
    return E[0] if c is None else np.stack(E, -1)
