import numpy as np


def to_radiance(pixels):
    e = pixels[..., 3].astype(np.int32)
    f = np.ldexp(1.0, e - (128 + 8))
    f[e == 0] = 0
    return pixels[..., :3] * f[..., None]
