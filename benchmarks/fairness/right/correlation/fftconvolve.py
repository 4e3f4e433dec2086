"""Convolution with the reversed photo."""

import numpy as np
from scipy.ndimage import gaussian_filter
from scipy.signal import fftconvolve


def correlation(X):
    centered = []
    for x in X.astype(float):
        kept = ~np.isnan(x)
        mean = gaussian_filter(np.where(kept, x, 0.0), 4) / gaussian_filter(kept.astype(float), 4)
        centered.append(np.where(kept, x - mean, 0.0))
    return fftconvolve(centered[0], centered[1][::-1, ::-1])
