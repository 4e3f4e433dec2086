"""A binomial blur, edges mirrored about the last pixel."""

import numpy as np
from scipy.ndimage import correlate1d, map_coordinates


def halve(l):
    return correlate1d(
        correlate1d(l, np.array([1, 4, 6, 4, 1]) / 16, 0), np.array([1, 4, 6, 4, 1]) / 16, 1
    )[::2, ::2]


def enlarge(P, shape):
    at = np.meshgrid(*[np.arange(n) / 2 for n in shape], indexing="ij")
    return map_coordinates(P, at, order=1, mode="nearest")


def slope_of(l, k):
    wide = np.pad(l, 1, mode="symmetric")
    dy = (wide[2:, 1:-1] - wide[:-2, 1:-1]) / 2 ** (k + 1)
    dx = (wide[1:-1, 2:] - wide[1:-1, :-2]) / 2 ** (k + 1)
    return np.hypot(dy, dx)


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    levels = [np.asarray(lL, float)]
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
