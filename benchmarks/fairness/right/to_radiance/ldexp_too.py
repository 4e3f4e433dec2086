"""np.ldexp with signed exponents, float32."""

import numpy as np


def to_radiance(pixels):
    pixels = np.asarray(pixels)
    e = pixels[..., 3:].astype(np.int32)
    E = np.ldexp(pixels[..., :3].astype(np.float32), e - 136)
    return np.where(e == 0, np.float32(0), E)
