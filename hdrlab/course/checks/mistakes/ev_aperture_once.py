"""The light goes with the area of the aperture, which is 1 / F squared: each f-number counts twice, 2
log2 F."""

import numpy as np


def ev(F, T, *, S=100.0):
    return np.log2(F) - np.log2(T) - np.log2(S / 100)
