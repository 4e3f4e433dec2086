"""The slope from the dark pair to each other pair; their mean, weighted by (S / V)^2."""

import numpy as np


def line(S, V):
    S, V = S[1:], np.asarray(V)
    slopes = (V[1:] - V[0]) / S
    return np.average(slopes, weights=(S / V[1:]) ** 2)
