import numpy as np


def update(Z, t, E, n=256):
    ok = ~np.isnan(E)
    f = np.zeros(n)
    for m in range(n):
        rows, cols = np.nonzero(Z[ok] == m)
        if len(rows) > 0:
            f[m] = np.sum(E[ok][rows]) / len(rows)
    return f
