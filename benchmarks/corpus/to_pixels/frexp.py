import numpy as np


def to_pixels(E):
    brightest = np.max(E, axis=2)
    mantissa, exponent = np.frexp(brightest)
    scale = np.zeros_like(brightest, dtype=float)
    lit = brightest > 1e-32
    scale[lit] = mantissa[lit] * 256.0 / brightest[lit]
    rgbe = np.zeros(E.shape[:2] + (4,), np.uint8)
    rgbe[..., :3] = np.floor(E * scale[..., None])
    rgbe[..., 3] = np.where(lit, exponent + 128, 0)
    return rgbe
