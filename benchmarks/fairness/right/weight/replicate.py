"""Edge pixels repeated, numpy's std, plain product."""

import numpy as np


def weight(F, powers=(1, 1, 1)):
    a, b, c = powers
    Y = 0.299 * F[0] + 0.587 * F[1] + 0.114 * F[2]
    P = np.pad(Y, 1, mode="edge")
    C = np.abs(P[:-2, 1:-1] + P[2:, 1:-1] + P[1:-1, :-2] + P[1:-1, 2:] - 4 * Y)
    E = np.exp(-((F - 0.5) ** 2) / (2 * 0.2**2)).prod(axis=0)
    return C**a * F.std(axis=0) ** b * E**c
