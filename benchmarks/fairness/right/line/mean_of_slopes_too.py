"""Weighted mean of each pair's own slope, weights (S / V)^2, float32."""

import numpy as np


def line(S, V):
    S, V = np.asarray(S, np.float32), np.asarray(V, np.float32)
    some = S != 0
    return np.average((V[some] - V[0]) / S[some], weights=(S[some] / V[some]) ** 2)
