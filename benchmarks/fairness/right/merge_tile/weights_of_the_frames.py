"""The same mean, written as weights of the reference and of the other frame."""

import numpy as np


def merge_tile(T, variance, *, tuning):
    n = T.shape[-1]
    F = np.fft.fft2(np.asarray(T, float))
    power = np.abs(F - F[0]) ** 2
    keep = tuning * 2 * n * n * variance / (power + tuning * 2 * n * n * variance)
    pairs = keep * F + (1 - keep) * F[0]
    return np.fft.ifft2(pairs.mean(axis=0)).real
