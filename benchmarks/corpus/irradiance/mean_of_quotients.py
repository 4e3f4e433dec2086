import numpy as np


def irradiance(Z, t, f_inv, w):
    weight = w[Z]
    with np.errstate(all="ignore"):
        return np.sum(weight * f_inv[Z] / t, axis=1) / np.sum(weight, axis=1)
