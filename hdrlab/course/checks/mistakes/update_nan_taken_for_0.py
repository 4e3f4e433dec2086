"""A sample whose irradiance is not known is left out; you count it as 0, and draw its levels down."""

import numpy as np


def update(Z, t, E, n=256):
    X = np.nan_to_num(E)[:, None] * t
    with np.errstate(invalid="ignore"):
        return np.bincount(Z.ravel(), X.ravel(), n) / np.bincount(Z.ravel(), minlength=n)
