"""Step by step: out of one pixel, into the next; float32."""

import numpy as np


def divergence(G):
    H, W = G.shape[1:]
    out = np.zeros((H, W), np.float32)
    for y in range(H):
        for x in range(W):
            if y + 1 < H:
                out[y, x] += G[0, y, x]
                out[y + 1, x] -= G[0, y, x]
            if x + 1 < W:
                out[y, x] += G[1, y, x]
                out[y, x + 1] -= G[1, y, x]
    return out
