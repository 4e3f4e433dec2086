"""Zeros first, then only the pixels with an exponent by their indices, channel by channel; float32."""

import numpy as np


def to_radiance(pixels):
    pixels = np.array(pixels, dtype=np.int64)
    E = np.zeros(pixels.shape[:-1] + (3,), dtype=np.float32)
    lit = np.nonzero(pixels[..., 3])
    power = np.power(2.0, pixels[..., 3][lit] - 128)
    for c in range(3):
        E[lit + (c,)] = pixels[..., c][lit] * power / 256
    return E
