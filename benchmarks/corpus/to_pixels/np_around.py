import numpy as np


def to_pixels(E):
    brightest = np.maximum(np.maximum(E[..., 0], E[..., 1]), E[..., 2])
    mantissa, exponent = np.frexp(brightest)
    scaled = mantissa * 256.0 / np.where(brightest > 0, brightest, 1)
    rgbe = np.zeros((E.shape[0], E.shape[1], 4))
    rgbe[..., 0:3] = np.around(E * scaled[..., None])
    rgbe[..., 3] = np.around(exponent + 128)
    rgbe[rgbe > 255] = 255
    rgbe[rgbe < 0] = 0
    rgbe[brightest == 0] = 0
    return rgbe.astype(np.uint8)
