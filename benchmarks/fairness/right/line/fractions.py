"""Exact fractions, a 0-d array as the answer."""

from fractions import Fraction

import numpy as np


def line(S, V):
    S = [Fraction(float(s)) for s in S]
    V = [Fraction(float(v)) for v in V]
    above = sum(s * (v - V[0]) / (v * v) for s, v in zip(S, V))
    return np.array(float(above / sum(s * s / (v * v) for s, v in zip(S, V))))
