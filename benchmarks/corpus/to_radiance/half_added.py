import numpy as np


def to_radiance(pixels):
    e = pixels[..., 3:].astype(float)
    E = (pixels[..., :3] + 0.5) / 256 * 2.0 ** (e - 128)
    return np.where(e == 0, 0, E)
