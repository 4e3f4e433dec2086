"""You read the mantissa like that of a float, 1 + m / 256; here it is m / 256 itself."""

import numpy as np


def to_radiance(pixels):
    e = pixels[..., 3:].astype(float)
    return np.where(e > 0, (1 + pixels[..., :3] / 256) * 2.0 ** (e - 128), 0)
