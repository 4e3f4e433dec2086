"""Products of spectra, padded to the whole length; float32."""

import numpy as np


def smear(x, h):
    n = len(x) + len(h) - 1
    X = np.fft.fft(x.reshape(len(x), -1), n, axis=0)
    H = np.fft.fft(h, n)[:, None]
    return np.fft.ifft(X * H, axis=0).real.reshape(n, *x.shape[1:]).astype(np.float32) / len(h)
