"""Frame by frame."""

import numpy as np


def irradiance(Z, t, f_inv, w):
    above, below = np.zeros(len(Z)), np.zeros(len(Z))
    for j, tj in enumerate(t):
        above += w[Z[:, j]] * tj * f_inv[Z[:, j]]
        below += w[Z[:, j]] * tj * tj
    E = np.full(len(Z), np.nan)
    E[below > 0] = above[below > 0] / below[below > 0]
    return E
