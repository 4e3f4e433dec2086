"""The same limits for all classes."""

import numpy as np


def spread(L, Ld, *, bins=64):
    return np.linspace(L.min(), L.max(), bins), np.zeros(bins), np.ones(bins)
