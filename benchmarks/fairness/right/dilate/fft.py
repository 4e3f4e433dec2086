"""Convolution with a disc by FFT; outside spreads inward by binary_propagation; float 0 and 1."""

import numpy as np
from scipy import ndimage, signal


def dilate(mask, margin):
    y, x = np.ogrid[-margin : margin + 1, -margin : margin + 1]
    disc = (y * y + x * x <= margin * margin).astype(float)
    wide = signal.fftconvolve(np.asarray(mask, float), disc, mode="full") > 0.5
    wide = wide[margin : wide.shape[0] - margin, margin : wide.shape[1] - margin]
    rest = np.pad(~wide, 1, constant_values=True)
    seed = np.zeros_like(rest)
    seed[0] = seed[-1] = True
    seed[:, 0] = seed[:, -1] = True
    out = ndimage.binary_propagation(seed, mask=rest)
    return (~out[1:-1, 1:-1]).astype(float)
