"""As float."""

import numpy as np


def to_radiance(pixels):
    p = pixels.astype(float)
    return np.where(p[..., 3:] == 0, 0, p[..., :3] / 256 * 2 ** (p[..., 3:] - 128))
