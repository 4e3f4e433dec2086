"""A higher ISO speed needs less light, so it lowers the exposure value: subtract log2(S / 100)."""

import numpy as np


def ev(F, T, *, S=100.0):
    return 2 * np.log2(F) - np.log2(T) + np.log2(S / 100)
