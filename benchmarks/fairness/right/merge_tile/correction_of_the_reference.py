"""The noise of the reference is subtracted, in the pixels of the tile."""

import numpy as np


def merge_tile(T, variance, *, tuning):
    N = len(T)
    n = T.shape[1]
    correction = np.zeros((n, n))
    for z in range(1, N):
        D = np.fft.fft2(T[0] - T[z])
        A = np.abs(D) ** 2 / (np.abs(D) ** 2 + tuning * 2 * n**2 * variance)
        correction += np.fft.ifft2((1 - A) * D).real
    return T[0] - correction / N
