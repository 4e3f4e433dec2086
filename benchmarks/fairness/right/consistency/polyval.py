"""polyval, and a mask beyond the limit."""

import numpy as np


def consistency(v, v_):
    d = np.linalg.norm(v - v_, ord=np.inf, axis=-1) / (16 / 255)
    f = np.polyval([2, -3, 0, 1], d)
    f[d >= 1] = 0
    return f[:, :, None]
