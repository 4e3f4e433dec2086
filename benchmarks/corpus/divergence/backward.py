import numpy as np


def divergence(G):
    gy = np.array(G[0], dtype=float)
    gx = np.array(G[1], dtype=float)
    gy[-1, :] = 0
    gx[:, -1] = 0
    div = np.zeros_like(gy)
    H, W = gy.shape
    for y in range(H):
        for x in range(W):
            div[y, x] = gy[y, x] + gx[y, x]
            if y > 0:
                div[y, x] -= gy[y - 1, x]
            if x > 0:
                div[y, x] -= gx[y, x - 1]
    return div
