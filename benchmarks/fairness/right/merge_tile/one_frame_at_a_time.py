"""A loop over the frames, which adds up the sum."""

import numpy as np


def merge_tile(T, variance, *, tuning):
    reference = np.fft.fft2(T[0])
    total = reference.copy()
    for tile in T[1:]:
        F = np.fft.fft2(tile)
        D = reference - F
        power = D.real**2 + D.imag**2
        A = power / (power + tuning * 2 * tile.size * variance)
        total += F + A * D
    return np.real(np.fft.ifft2(total / len(T)))
