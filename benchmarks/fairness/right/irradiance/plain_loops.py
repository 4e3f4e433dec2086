"""Loops over samples and photographs in plain Python; levels without weight are passed over."""

import math

import numpy as np


def irradiance(Z, t, f_inv, w):
    t, f_inv, w = ([float(x) for x in values] for values in (t, f_inv, w))
    E = []
    for levels in np.asarray(Z).tolist():
        above = below = 0.0
        for level, time in zip(levels, t):
            if w[level] == 0:
                continue
            above += w[level] * time * f_inv[level]
            below += w[level] * time * time
        E.append(above / below if below > 0 else math.nan)
    return np.array(E, dtype=np.float64)
