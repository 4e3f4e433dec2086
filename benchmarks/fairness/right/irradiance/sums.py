"""Two sums."""

import numpy as np


def irradiance(Z, t, f_inv, w):
    t = np.asarray(t, float)
    with np.errstate(invalid="ignore"):
        return (w[Z] * t * f_inv[Z]).sum(axis=1) / (w[Z] * t**2).sum(axis=1)
