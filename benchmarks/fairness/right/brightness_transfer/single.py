"""Counts scaled to B's sum, two hands that walk up both histograms, answer in float32."""

import numpy as np


def brightness_transfer(h_A, h_B):
    n = len(h_A)
    scale = float(np.sum(h_B)) / float(np.sum(h_A))
    T, z, low, below = [], 0, 0.0, 0.0
    for m in range(n):
        rank = (below + float(h_A[m]) / 2) * scale
        below += float(h_A[m])
        while z < n - 1 and low + h_B[z] <= rank:
            low += float(h_B[z])
            z += 1
        part = (rank - low) / h_B[z] if h_B[z] else 0.0
        place = z - 0.5 + min(part, 1.0)
        T.append(place if 0.5 <= place <= n - 1.5 else np.nan)
    return np.array(T, np.float32)
