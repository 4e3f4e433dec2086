"""Convolutions with a kernel of ones."""

import numpy as np
from scipy.ndimage import convolve


def join_sensors(B, D, full):
    ones = np.ones((5, 5))

    def total(a):
        return convolve(np.asarray(a, float), ones, mode="nearest")

    n = np.rint(total(full))
    u = n / 25
    E = np.array(B, float)
    P = np.copy(E)
    part = full & (n < 25)
    P[part] = (D * total(np.where(full, 0, B)) / np.maximum(total(np.where(full, 0, D)), 1e-12))[
        part
    ]
    some = n > 0
    E[some] = ((1 - u) * P + u * D)[some]
    E[n == 25] = D[n == 25]
    case = 1 + some + full
    case[full] += n[full] == 25
    return E, case
