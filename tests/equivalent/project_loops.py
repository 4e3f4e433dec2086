"""A project in loops: the rank of each pixel's brightness, in part."""

# %% task="tonemap"
import math

import numpy as np


def tonemap(L):
    values = [float(v) for v in np.ravel(L)]
    lit = sorted(v for v in values if v > 0)
    if not lit:
        return np.zeros(np.shape(L))
    median = lit[len(lit) // 2]
    shown = []
    for v in values:
        stops = math.log2(v / median) if v > 0 else -200.0
        shown.append(1 / (1 + math.exp(-0.5 * max(min(stops, 200), -200))))
    return np.reshape(shown, np.shape(L))
