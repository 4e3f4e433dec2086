"""The update of f^-1 is a plain mean over the pixels of a level; with the times as weights it rests on
another curve."""

import numpy as np


def update(Z, t, E, n=256):
    known = ~np.isnan(E)
    Z, T = Z[known], np.broadcast_to(t, Z[known].shape)
    above = np.bincount(Z.ravel(), (E[known, None] * T**2).ravel(), n)
    with np.errstate(invalid="ignore"):
        return above / np.bincount(Z.ravel(), T.ravel(), n)
