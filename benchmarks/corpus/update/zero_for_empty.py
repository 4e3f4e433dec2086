import numpy as np


def update(Z, t, E, n=256):
    good = ~np.isnan(E)
    Z = Z[good]
    X = np.outer(E[good], t)
    out = np.zeros(n)
    for m in range(n):
        mask = Z == m
        if mask.any():
            out[m] = X[mask].mean()
    return out
