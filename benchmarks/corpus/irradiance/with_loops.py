import numpy as np


def irradiance(Z, t, f_inv, w):
    N, P = Z.shape
    E = np.zeros(N)
    for i in range(N):
        top = 0.0
        bottom = 0.0
        for j in range(P):
            top += w[Z[i, j]] * t[j] * f_inv[Z[i, j]]
            bottom += w[Z[i, j]] * t[j] ** 2
        E[i] = top / bottom if bottom > 0 else np.nan
    return E
