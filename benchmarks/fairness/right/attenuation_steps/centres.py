"""Pixels as areas when enlarging; float32."""

import numpy as np
from scipy.ndimage import gaussian_filter, map_coordinates


def halve(l):
    return gaussian_filter(l, 0.8)[::2, ::2]


def enlarge(P, shape):
    ys, xs = ((np.arange(n) + 0.5) * m / n - 0.5 for n, m in zip(shape, P.shape, strict=True))
    return map_coordinates(P, np.meshgrid(ys, xs, indexing="ij"), order=1, mode="nearest")


def slope_of(l, k):
    wide = np.pad(l, 1, mode="symmetric")
    dy = (wide[2:, 1:-1] - wide[:-2, 1:-1]) / 2 ** (k + 1)
    dx = (wide[1:-1, 2:] - wide[1:-1, :-2]) / 2 ** (k + 1)
    return np.hypot(dy, dx)


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    levels = [np.asarray(lL, np.float32)]
    while min(-(-n // 2) for n in levels[-1].shape) >= 32:
        levels.append(halve(levels[-1]))
    Phi = None
    for k in range(len(levels) - 1, -1, -1):
        slope = slope_of(levels[k], k)
        mean = slope.mean()
        if mean > 0:
            phi = (np.maximum(slope, noise * mean) / (alpha * mean)) ** (beta - 1)
        else:
            phi = np.ones(slope.shape)
        Phi = phi if Phi is None else enlarge(Phi, phi.shape) * phi
        yield k, levels[k], slope, phi, Phi
