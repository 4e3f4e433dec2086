"""A loop over all offsets of the window that adds rolled pictures, so that the picture goes round at its
edge."""

import itertools

import numpy as np


def guided(I, p=None, *, radius, epsilon):
    I = np.array(I, dtype=float)
    if p is None:
        p = I
    p = np.array(p, dtype=float)
    offsets = list(itertools.product(range(-radius, radius + 1), repeat=2))
    n = len(offsets)

    mI, mp = np.zeros_like(I), np.zeros_like(I)
    for o in offsets:
        mI += np.roll(I, o, axis=(0, 1)) / n
        mp += np.roll(p, o, axis=(0, 1)) / n
    var, cov = np.zeros_like(I), np.zeros_like(I)
    for o in offsets:
        d = np.roll(I, o, axis=(0, 1)) - mI
        var += d * d / n
        cov += d * (np.roll(p, o, axis=(0, 1)) - mp) / n
    a = cov / (var + epsilon)
    b = mp - a * mI
    q = np.zeros_like(I)
    for o in offsets:
        q += (np.roll(a, o, axis=(0, 1)) * I + np.roll(b, o, axis=(0, 1))) / n
    return q
