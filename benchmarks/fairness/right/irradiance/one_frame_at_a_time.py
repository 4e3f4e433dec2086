"""Accumulates frame by frame, as one reads photographs from disk; a mask sets NaN at the end."""

import numpy as np


def irradiance(Z, t, f_inv, w):
    columns = np.asarray(Z, dtype=np.intp).T
    w = np.asarray(w, dtype=float)
    f_inv = np.asarray(f_inv, dtype=float)
    above = np.zeros(columns.shape[1])
    below = np.zeros(columns.shape[1])
    for z, time in zip(columns, t):
        trust = w[z]
        above += trust * time * f_inv[z]
        below += trust * time**2
    seen = below > 0
    E = np.where(seen, above, np.nan)
    E[seen] /= below[seen]
    return E
