import numpy as np


def irradiance(Z, t, f_inv, w):
    eps = 1.0e-10
    dt = np.asarray(t)[np.newaxis, :]
    num = np.sum(w[Z] * f_inv[Z] * dt, axis=1)
    den = np.sum(w[Z] * dt**2, axis=1) + eps
    return num / den
