"""Weights 1 / V."""

import numpy as np


def line(S, V):
    return np.sum(S * (V - V[0]) / V) / np.sum(S**2 / V)
