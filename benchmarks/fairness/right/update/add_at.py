"""np.add.at, float32."""

import numpy as np


def update(Z, t, E, n=256):
    total, count = np.zeros(n, np.float32), np.zeros(n, np.float32)
    for j in range(len(t)):
        ok = ~np.isnan(E)
        np.add.at(total, Z[ok, j], (E[ok] * t[j]).astype(np.float32))
        np.add.at(count, Z[ok, j], 1)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)
