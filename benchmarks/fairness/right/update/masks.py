"""A mask for each level."""

import numpy as np


def update(Z, t, E, n=256):
    X = np.asarray(E)[:, None] * np.asarray(t)[None]
    f = np.full(n, np.nan)
    for m in range(n):
        own = X[(Z == m) & np.isfinite(X)]
        if own.size:
            f[m] = own.mean()
    return f
