import numpy as np


def divergence(G):
    gy, gx = G[0].copy(), G[1].copy()
    gy[-1] = 0
    gx[:, -1] = 0
    return gy - np.roll(gy, 1, axis=0) + gx - np.roll(gx, 1, axis=1)
