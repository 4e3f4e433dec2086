"""The smooth step as an integral: 1 - 6 times the integral of t (1 - t)."""

import numpy as np


def consistency(v, v_):
    d = np.sort(np.abs(np.float64(v) - v_), axis=-1)[..., -1:] / 16 * 255
    d = 1 - np.maximum(1 - d, 0)
    return 1 - 6 * (d * d / 2 - d**3 / 3)
