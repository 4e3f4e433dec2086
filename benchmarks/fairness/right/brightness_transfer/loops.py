"""A rank for each level of A; a walk along B's levels until the rank lies on a step."""

import numpy as np


def brightness_transfer(h_A, h_B):
    n = len(h_A)
    total_a, total_b = float(sum(h_A)), float(sum(h_B))
    T, below = np.full(n, np.nan), 0.0
    for m in range(n):
        rank = (below + h_A[m] / 2) / total_a
        below += h_A[m]
        lower = 0.0
        for z in range(n):
            upper = lower + h_B[z] / total_b
            if lower <= rank <= upper and upper > lower:
                if 0 < z < n - 1:
                    T[m] = z - 0.5 + (rank - lower) / (upper - lower)
                break
            lower = upper
    return T
