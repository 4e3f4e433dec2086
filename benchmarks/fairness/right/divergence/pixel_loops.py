"""The four steps of each pixel, one by one, in plain Python."""

import numpy as np


def divergence(G):
    G = np.asarray(G, dtype=np.float64)
    H, W = G.shape[1:]
    Gy, Gx = G[0].tolist(), G[1].tolist()
    out = []
    for y in range(H):
        row = []
        for x in range(W):
            down = Gy[y][x] if y < H - 1 else 0.0
            up = Gy[y - 1][x] if y > 0 else 0.0
            right = Gx[y][x] if x < W - 1 else 0.0
            left = Gx[y][x - 1] if x > 0 else 0.0
            row.append(down - up + right - left)
        out.append(row)
    return np.array(out)
