import numpy as np


def divergence(G):
    Gy, Gx = np.asarray(G)
    d = Gy + Gx
    d[1:, :] -= Gy[:-1, :]
    d[:, 1:] -= Gx[:, :-1]
    return d
