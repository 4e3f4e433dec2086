"""Single precision, where for 0 / 0."""

import numpy as np


def irradiance(Z, t, f_inv, w):
    t, f, w = (np.asarray(one, np.float32) for one in (t, f_inv, w))
    below = w[Z] @ t**2
    return np.where(below == 0, np.nan, ((w * f)[Z] @ t) / np.where(below == 0, 1, below))
