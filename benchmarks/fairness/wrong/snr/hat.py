"""The hat weight."""

import numpy as np


def snr(g, *, least=0.01, span=4):
    z = np.arange(len(g))
    return np.minimum(z, len(g) - 1 - z) / (len(g) // 2)
