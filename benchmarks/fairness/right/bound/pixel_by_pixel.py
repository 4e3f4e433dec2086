"""A loop over the pixels with two lists of bounds for each; results as arrays of float64 and uint8."""

import math

import numpy as np


def bound(Z, B, g, top, shown):
    Z = np.asarray(Z).tolist()
    shown = np.asarray(shown).tolist()
    frames = range(len(Z))
    E, flags = [], []
    for m in range(len(Z[0])):
        lows = [float(g[top]) - float(B[j]) for j in frames if shown[j][m] and Z[j][m] >= top]
        highs = [float(g[1]) - float(B[j]) for j in frames if shown[j][m] and Z[j][m] == 0]
        if lows and highs:
            E.append(math.exp(0.5 * (max(lows) + min(highs))))
            flags.append(3)
        elif lows:
            E.append(math.exp(max(lows)))
            flags.append(1)
        elif highs:
            E.append(math.exp(min(highs)))
            flags.append(2)
        else:
            E.append(0.0)
            flags.append(8)
    return np.array(E, dtype=np.float64), np.array(flags, dtype=np.uint8)
