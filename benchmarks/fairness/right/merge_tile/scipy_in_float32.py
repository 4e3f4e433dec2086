"""The transforms of SciPy, and float32 in the end."""

import numpy as np
from scipy import fft


def shrink(D, S, c):
    squared = (D * D.conj()).real
    return squared / (squared + c * S)


def merge_tile(T, variance, *, tuning):
    F = fft.fft2(T)
    S = 2 * T.shape[1] * T.shape[2] * variance
    merged = F[0] / len(T)
    for k in range(1, len(T)):
        D = F[0] - F[k]
        merged = merged + (F[k] + shrink(D, S, tuning) * D) / len(T)
    return fft.ifft2(merged).real.astype(np.float32)
