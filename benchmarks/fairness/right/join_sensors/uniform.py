"""uniform_filter and np.select."""

import numpy as np
from scipy.ndimage import uniform_filter


def join_sensors(B, D, full):
    u = np.round(uniform_filter(full * 1.0, size=5, mode="nearest") * 25) / 25
    b = uniform_filter(B * ~full, size=5, mode="nearest")
    d = uniform_filter(D * ~full, size=5, mode="nearest")
    P = D * b / np.where(u < 1, d, 1)
    case = np.select([~full & (u == 0), ~full, u < 1], [1, 2, 3], 4)
    E = np.select(
        [case == 1, case == 2, case == 3], [B, (1 - u) * B + u * D, (1 - u) * P + u * D], D
    )
    return E, case
