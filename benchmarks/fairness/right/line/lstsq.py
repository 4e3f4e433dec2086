"""A row for each pair, divided by its variance, handed to least squares."""

import numpy as np


def line(S, V):
    S, V = np.asarray(S, float), np.asarray(V, float)
    slope, *_ = np.linalg.lstsq((S / V)[:, None], (V - V[0]) / V, rcond=None)
    return slope[0]
