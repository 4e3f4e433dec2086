"""A mantissa is a fraction of 256, and you did not divide: your radiance is 256 times too large, like a
triple that one lecture prints."""

import numpy as np


def to_radiance(pixels):
    e = pixels[..., 3:].astype(int)
    return np.where(e > 0, pixels[..., :3] * 2.0 ** (e - 128), 0)
