import numpy as np


def fix_uncertain(mean, k, *, sigma_s):
    """The blur in the Fourier domain: past the edge, the picture begins anew."""
    mean = np.asarray(mean, dtype=float)
    H, W = mean.shape
    fy = np.fft.fftfreq(H)[:, None]
    fx = np.fft.rfftfreq(W)[None]
    G = np.exp(-2 * np.pi**2 * 2.0**2 * (fy**2 + fx**2))
    blur = np.fft.irfft2(np.fft.rfft2(mean) * G, s=(H, W))
    top = 0.5 * np.log(2 * np.pi * sigma_s**2)
    u = np.log(np.clip(k, 1.0, np.exp(top))) / top
    return u * mean + (1 - u) * blur
