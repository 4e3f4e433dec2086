"""Two matrix products with t and t^2, and a division where the denominator is not zero."""

import numpy as np


def irradiance(Z, t, f_inv, w):
    t = np.asarray(t, dtype=np.float64)
    w = np.asarray(w, dtype=np.float64)
    weighted = w * np.asarray(f_inv, dtype=np.float64)
    numerator = np.take(weighted, Z) @ t
    denominator = np.take(w, Z) @ (t * t)
    return np.divide(
        numerator, denominator, out=np.full(len(numerator), np.nan), where=denominator != 0
    )
