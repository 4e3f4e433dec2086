"""1 / (1 - s) times F, and -s / (1 - s) times G."""

import numpy as np


def subtract_glare(F, G, share):
    odds = share / (1 - share)
    return np.fmax((1 + odds) * F - odds * G, (1 + odds) * F * np.float32(1e-3))
