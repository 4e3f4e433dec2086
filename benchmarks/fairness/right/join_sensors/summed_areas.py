"""Integral images."""

import numpy as np


def box(a):
    s = np.zeros(np.array(a.shape) + 5)
    s[1:, 1:] = np.pad(np.asarray(a, float), 2, mode="edge").cumsum(0).cumsum(1)
    return s[5:, 5:] - s[:-5, 5:] - s[5:, :-5] + s[:-5, :-5]


def join_sensors(B, D, full):
    u = np.round(box(full)) / 25
    none, every = u < 0.01, u > 0.99
    b, d = box(np.where(full, 0, B)), box(np.where(full, 0, D))
    P = D * b / np.where(d > 1e-6, d, 1)
    mixed = u * D + (1 - u) * np.where(full, P, B)
    E = np.where(every, D, np.where(none, B, mixed))
    cases = 1 * none + 2 * (~none & ~full) + 3 * (full & ~every) + 4 * every
    return E.astype(np.float32), cases
