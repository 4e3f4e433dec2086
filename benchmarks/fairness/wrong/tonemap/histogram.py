"""A project by histogram equalisation of the logarithm, half of it."""

import numpy as np


def tonemap(L, **knobs):
    L = np.asarray(L, float)
    flat = np.sort(L.ravel())
    rank = (np.searchsorted(flat, L, "left") + np.searchsorted(flat, L, "right")) / (2 * L.size)
    return rank.clip(0, 1)
