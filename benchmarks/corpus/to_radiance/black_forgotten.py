import numpy as np


def to_radiance(pixels):
    rgb = pixels[:, :, :3].astype(np.float64) / 256.0
    exp = pixels[:, :, 3].astype(np.float64) - 128.0
    return rgb * np.power(2.0, exp)[:, :, np.newaxis]
