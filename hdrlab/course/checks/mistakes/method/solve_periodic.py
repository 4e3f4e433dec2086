"""You solved with a Fourier transform, as if the picture went on at the other side: its edges bend to
each other. Use cosines."""

import numpy as np


def solve(divG):
    factors = np.add.outer(*(2 * np.cos(2 * np.pi * np.arange(n) / n) - 2 for n in divG.shape))
    factors[0, 0] = 1
    F = np.fft.fft2(divG) / factors
    F[0, 0] = 0
    return np.fft.ifft2(F).real
