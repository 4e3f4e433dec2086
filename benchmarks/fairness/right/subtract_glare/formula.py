"""As it is on the sheet."""

import numpy as np


def subtract_glare(F, G, share):
    return np.maximum(F - share * G, F / 1000) / (1 - share)
