"""np.average of what each photograph says, f^-1(Z) / t, with weights w t^2."""

import numpy as np


def irradiance(Z, t, f_inv, w):
    Z = np.asarray(Z)
    t = np.asarray(t, dtype=float)[None, :]
    says = np.asarray(f_inv, dtype=float)[Z] / t
    weights = np.asarray(w, dtype=float)[Z] * t**2
    good = weights.sum(axis=1) > 0
    E = np.empty(Z.shape[0])
    E.fill(np.nan)
    if good.any():
        E[good] = np.average(says[good], weights=weights[good], axis=1)
    return E
