"""The blur in frequencies: the picture goes round."""

import numpy as np
from scipy.ndimage import fourier_gaussian


def fix_uncertain(mean, k, *, sigma_s):
    smooth = np.fft.ifft2(fourier_gaussian(np.fft.fft2(mean), 2)).real
    root = np.sqrt(2 * np.pi) * sigma_s
    u = np.where(k >= root, 1, np.where(k <= 1, 0, np.log2(np.maximum(k, 1e-9)) / np.log2(root)))
    return u * mean + (1 - u) * smooth
