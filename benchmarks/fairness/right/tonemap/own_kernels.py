"""Separable kernels, np.convolve with repeated edges; white by sorting and dropping 0.01 % of the pixels."""

import math

import numpy as np


def blur(picture, sigma):
    r = max(1, math.ceil(4 * sigma))
    k = np.exp(-0.5 * (np.arange(-r, r + 1) / sigma) ** 2)
    k /= k.sum()
    for _ in range(2):
        picture = np.stack(
            [np.convolve(np.pad(row, r, mode="edge"), k, "valid") for row in picture]
        ).T
    return picture


def log_average(L):
    lit = L[L > 0]
    return math.exp(np.log(L + 1e-6 * np.median(lit)).mean()) if lit.size else 1.0


def white_point(Lm):
    values = sorted(Lm.ravel().tolist(), reverse=True)
    return max(values[int(0.0001 * len(values))], 1.0)


def neighbourhood(Lm, key, phi, threshold):
    V1 = blur(Lm, 0.25)
    adaptation, even = V1.copy(), np.full(Lm.shape, True)
    s = 1.0
    while s < 1.6**7.5:
        V2 = blur(Lm, 1.6 * s / 4)
        even[np.abs((V1 - V2) / (2**phi * key / s**2 + V1)) >= threshold] = False
        adaptation[even] = V1[even]
        V1, s = V2, 1.6 * s
    return adaptation


def tonemap(L, *, key=0.18, white=None, local=False, phi=8.0, threshold=0.05):
    L = np.array(L, dtype=float)
    if L.ndim != 2:
        raise ValueError("L must be (H, W)")
    if not np.all(np.isfinite(L)) or np.any(L < 0):
        raise ValueError("L must be finite and not negative")
    if key == "auto":
        raise ValueError('key="auto" is the library\'s alone')
    if min(key, phi, threshold, 1 if white is None else white) <= 0:
        raise ValueError("key, white, phi and threshold must be above 0")
    Lm = L * (key / log_average(L))
    white = white_point(Lm) if white is None else white
    adaptation = neighbourhood(Lm, key, phi, threshold) if local else Lm
    return np.clip((Lm + (Lm / white) ** 2) / (1 + adaptation), 0, 1).astype(np.float32)
