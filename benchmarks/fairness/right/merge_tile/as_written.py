"""The text as it stands."""

import numpy as np


def merge_tile(T, variance, *, tuning):
    N, n, _ = T.shape
    F = np.fft.fft2(T)
    D = F[0] - F
    S = 2 * n**2 * variance
    A = np.abs(D) ** 2 / (np.abs(D) ** 2 + tuning * S)
    merged = (F + A * D).sum(axis=0) / N
    return np.fft.ifft2(merged).real
