"""The exponent from a base-2 logarithm, moved by one where rounding made it wrong; bright pixels only."""

import numpy as np


def to_pixels(E):
    E = np.asarray(E).astype(np.float64)
    H, W, _ = E.shape
    out = np.zeros((H, W, 4), np.uint8)
    v = E.max(axis=2)
    y, x = np.nonzero(v >= 2.0**-128)
    bright = v[y, x]
    e = np.floor(np.log2(bright)).astype(int) + 129
    e = np.where(256 * bright * 2.0 ** (128 - e) >= 256, e + 1, e)
    e = np.where(256 * bright * 2.0 ** (128 - e) < 128, e - 1, e)
    e = np.clip(e, 1, 255)
    m = np.floor(256 * E[y, x] * 2.0 ** (128.0 - e)[:, None])
    out[y, x, :3] = np.clip(m, 0, 255)
    out[y, x, 3] = e
    return out
