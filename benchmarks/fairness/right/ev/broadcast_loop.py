"""Broadcasts first, then loops over the settings in plain Python; a float for numbers, else an array."""

from math import log2

import numpy as np


def ev(F, T, *, S=100.0):
    settings = np.broadcast(np.asarray(F), np.asarray(T), np.asarray(S))
    for setting in (F, T, S):
        if any(not x > 0 for x in np.asarray(setting).ravel().tolist()):
            raise ValueError("every setting must be above zero")
    values = []
    for f, t, s in settings:
        values.append(2 * log2(f) - log2(t) - log2(s / 100))
    if settings.shape == ():
        return values[0]
    return np.array(values, dtype=float).reshape(settings.shape)
