"""A mask of what would be too small; float64."""

import numpy as np


def subtract_glare(F, G, share):
    F, G = F.astype(float), G.astype(float)
    E = F - share * G
    return np.where(E < F / 1000, F / 1000, E) / (1 - share)
