"""Clipped from 0 to 1, float64."""

import numpy as np


def display(Lm, adaptation, white=np.inf):
    Lm = np.asarray(Lm, float)
    burn = 0.0 if np.isinf(white) else 1 / white**2
    return np.clip((Lm + burn * Lm**2) / (1 + np.asarray(adaptation, float)), 0, 1)
