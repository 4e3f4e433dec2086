"""The fraction of F that is left, at least a thousandth."""

import numpy as np


def subtract_glare(F, G, share):
    left = np.clip(1 - share * (G / F), 0.001, None)
    return F * left / (1 - share)
