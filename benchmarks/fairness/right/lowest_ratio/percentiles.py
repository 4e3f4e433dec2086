"""Percentiles in float64, a pair as an array."""

import numpy as np


def lowest_ratio(F, G):
    ratios = np.array([f / g for f, g in zip(F.ravel().astype(float), G.ravel()) if g > 0])
    if len(ratios) < 5000:
        return (0.0, float("inf"))
    q = np.percentile(ratios, [0.02, 0.1, 1])
    return (np.maximum(2 * q[0] - q[1], 0.0), q[2] / q[0])
