"""Each step leaves one pixel and enters the next: two slices add, two subtract; the type of G is kept."""

import numpy as np


def divergence(G):
    G = np.asarray(G)
    out = np.zeros(G.shape[1:], dtype=np.result_type(G, np.float32))
    down, right = G[0, :-1], G[1, :, :-1]
    out[:-1, :] += down
    out[1:, :] -= down
    out[:, :-1] += right
    out[:, 1:] -= right
    return out
