"""The steps across the edges set to 0 in a copy, then np.diff with a 0 before the first."""

import numpy as np


def divergence(G):
    Gy, Gx = np.array(G)
    Gy[-1, :] = 0
    Gx[:, -1] = 0
    return np.diff(Gy, axis=0, prepend=0) + np.diff(Gx, axis=1, prepend=0)
