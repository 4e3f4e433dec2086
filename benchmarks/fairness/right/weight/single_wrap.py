"""float32, the picture goes on at its other side, at least 1e-9 in all pixels."""

import numpy as np


def weight(F, powers=(1, 1, 1)):
    F = np.asarray(F, np.float32)
    Y = np.float32(0.299) * F[0] + np.float32(0.587) * F[1] + np.float32(0.114) * F[2]
    C = np.abs(np.roll(Y, 1, 0) + np.roll(Y, -1, 0) + np.roll(Y, 1, 1) + np.roll(Y, -1, 1) - 4 * Y)
    S = np.std(F, axis=0)
    E = np.exp(np.float32(-12.5) * np.sum((F - np.float32(0.5)) ** 2, axis=0))
    a, b, c = (np.float32(p) for p in powers)
    return np.maximum(C**a * S**b * E**c, np.float32(1e-9))
