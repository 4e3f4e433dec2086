"""Burt and Adelson's 1 4 6 4 1, enlarged by np.interp along rows and columns between the pixels' centres."""

import numpy as np
from scipy.ndimage import convolve1d


class Level(tuple):
    """The sheet's five values, with their names, without typing.NamedTuple."""

    k = property(lambda self: self[0])
    lL = property(lambda self: self[1])
    slope = property(lambda self: self[2])
    phi = property(lambda self: self[3])
    Phi = property(lambda self: self[4])


TAPS = np.array([1, 4, 6, 4, 1]) / 16


def enlarged(small, shape):
    y = (np.arange(shape[0]) + 0.5) / 2 - 0.5
    x = (np.arange(shape[1]) + 0.5) / 2 - 0.5
    rows = np.stack([np.interp(x, np.arange(small.shape[1]), row) for row in small])
    return np.stack([np.interp(y, np.arange(small.shape[0]), column) for column in rows.T], axis=1)


def slope_of(l, k):
    p = np.pad(l, 1, mode="reflect")
    across = (p[1:-1, 2:] - p[1:-1, :-2]) / 2.0 ** (k + 1)
    down = (p[2:, 1:-1] - p[:-2, 1:-1]) / 2.0 ** (k + 1)
    return np.hypot(across, down)


def attenuation_steps(lL, *, alpha=0.1, beta=0.9, noise=0.01):
    l = np.asarray(lL, dtype=float)
    levels = [l]
    while -(-l.shape[0] // 2) >= 32 and -(-l.shape[1] // 2) >= 32:
        l = convolve1d(convolve1d(l, TAPS, 0, mode="reflect"), TAPS, 1, mode="reflect")[::2, ::2]
        levels.append(l)
    Phi = 1.0
    for k in range(len(levels))[::-1]:
        slope = slope_of(levels[k], k)
        mean = np.mean(slope)
        phi = np.ones(slope.shape)
        if mean > 0:
            phi = np.power(np.clip(slope, noise * mean, None) / (alpha * mean), beta - 1)
        Phi = phi if k == len(levels) - 1 else enlarged(Phi, slope.shape) * phi
        yield Level((k, levels[k], slope, phi, Phi))
