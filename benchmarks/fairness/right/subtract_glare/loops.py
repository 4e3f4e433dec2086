"""Pixel by pixel, in lists."""

import numpy as np


def subtract_glare(F, G, share):
    values = [
        max(float(f) - share * float(g), float(f) / 1000) / (1 - share)
        for f, g in zip(F.ravel(), G.ravel())
    ]
    return np.array(values).reshape(F.shape).tolist()
