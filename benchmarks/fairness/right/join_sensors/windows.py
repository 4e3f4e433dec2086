"""sliding_window_view and masked sums."""

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view


def windows(a):
    return sliding_window_view(np.pad(a, 2, "edge"), (5, 5))


def join_sensors(B, D, full):
    F = windows(full)
    u = F.mean(axis=(-1, -2))
    with np.errstate(all="ignore"):
        ratio = windows(B).sum((-1, -2), where=~F) / windows(D).sum((-1, -2), where=~F)
        bright = np.where(full, D * ratio, B)
        E = np.where(u == 1, D, (1 - u) * bright + u * D)
    case = np.where(full, 3 + (u == 1), 1 + (u > 0))
    return [E, case.astype(float)]
