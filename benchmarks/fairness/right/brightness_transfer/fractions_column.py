"""Ranks as whole numbers, counted in halves and crosswise, so nothing is rounded; a column comes back."""

import numpy as np


def brightness_transfer(h_A, h_B):
    a, b = [int(one) for one in h_A], [int(one) for one in h_B]
    A, B = sum(a), sum(b)
    edges = [0]
    for count in b:
        edges.append(edges[-1] + count)
    T, passed, z = [], 0, 0
    for count in a:
        twice = (2 * passed + count) * B
        passed += count
        while z < len(b) - 1 and 2 * A * edges[z + 1] < twice:
            z += 1
        inside = (twice - 2 * A * edges[z]) / (2 * A * b[z])
        T.append(z - 0.5 + inside if 0 < z < len(b) - 1 else np.nan)
    return np.array(T)[:, None]
