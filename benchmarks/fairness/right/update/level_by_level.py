"""Collects each level's pixels with a mask and takes their mean."""

import numpy as np


def update(Z, t, E, n=256):
    keep = np.isfinite(E)
    Z = np.asarray(Z)[keep]
    exposure = np.asarray(E, dtype=float)[keep, np.newaxis] * np.asarray(t, dtype=float)
    curve = np.full(n, np.nan)
    for m in range(n):
        members = exposure[Z == m]
        if members.size:
            curve[m] = members.mean()
    return curve
