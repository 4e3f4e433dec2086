import numpy as np


def update(Z, t, E, n=256):
    g = np.full(n, np.nan)
    for m in range(n):
        idx = np.where(Z == m)
        if len(idx[0]) == 0:
            continue
        total = 0
        for i, j in zip(idx[0], idx[1]):
            total += E[i] * t[j]
        g[m] = total / len(idx[0])
    return g
