"""25 shifted copies, added up."""

import numpy as np


def join_sensors(B, D, full):
    h, w = B.shape
    rows, columns = np.arange(h), np.arange(w)
    n = np.zeros((h, w), int)
    b, d = np.zeros((h, w)), np.zeros((h, w))
    for dy in range(-2, 3):
        for dx in range(-2, 3):
            at = np.ix_(np.clip(rows + dy, 0, h - 1), np.clip(columns + dx, 0, w - 1))
            n += full[at]
            b += np.where(full[at], 0, B[at])
            d += np.where(full[at], 0, D[at])
    u = n / 25.0
    P = np.where(full, np.divide(D * b, d, out=np.zeros((h, w)), where=d > 0), B)
    E = u * D + (1 - u) * P
    return E, np.where(full, np.where(n == 25, 4, 3), np.where(n, 2, 1)).astype(np.uint8)
